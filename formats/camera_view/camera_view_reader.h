// CameraViewReader: reads the stream of `dance capture --check` as its bytes come, in pieces of any
// length. The newest view and the newest status win.
//
// Units/frames: as camera_view.h. A record is a head (magic, version, kind, bytes of the body),
//               then the body; little-endian.
// Ownership:    owns one record's room and the newest picture; allocates in the constructor alone.
// Threads:      none inside.
// Failure:      the one place where the stream is checked. Bytes that are no record, and records of
//               another version, end the reading for good: fault(). A record whose numbers are out
//               of range is left out and counted; one of an unknown kind is skipped.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "formats/camera_view/camera_view.h"
#include "formats/camera_view/camera_view_record.h"

namespace dance {

class CameraViewReader {
 public:
  enum class Fault : std::uint8_t { kNone, kForeign, kOtherVersion };

  CameraViewReader();

  // Where the next bytes are to be put, never empty before a fault; then how many these were.
  std::span<std::uint8_t> room() { return std::span(record_).subspan(held_); }
  void add(std::size_t count);

  // True once after each that came.
  bool take_view();
  bool take_status();
  // The newest; the picture is good until the next add().
  const CameraFacts& facts() const { return facts_; }
  PreviewPicture picture() const;
  const CameraStatus& status() const { return status_; }

  Fault fault() const { return fault_; }
  std::uint64_t invalid() const { return invalid_; }

 private:
  void read_record(CameraRecordKind kind, std::span<const std::uint8_t> body);
  bool read_view(std::span<const std::uint8_t> body);
  bool read_status(std::span<const std::uint8_t> body);

  std::vector<std::uint8_t> record_;   // the begin of what is not whole yet
  std::vector<std::uint8_t> picture_;  // of the newest view
  std::size_t held_ = 0;
  int width_ = 0;
  int height_ = 0;
  CameraFacts facts_;
  CameraStatus status_;
  bool has_view_ = false;
  bool has_status_ = false;
  Fault fault_ = Fault::kNone;
  std::uint64_t invalid_ = 0;
};

}  // namespace dance
