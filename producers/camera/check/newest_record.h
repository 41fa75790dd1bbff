// NewestRecord: records to a program that may read slowly, or not at all: the newest view wins, a
// status is never left out for a view, and nothing waits. A record that was begun is finished.
//
// Units/frames: as formats/camera_view/.
// Ownership:    borrows the file descriptor, which it makes non-blocking; owns three records.
// Threads:      none inside.
// Failure:      is_closed() once the reader is gone, or the descriptor refuses otherwise.
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "formats/camera_view/camera_view_writer.h"

namespace dance {

class NewestRecord {
 public:
  // SIGPIPE has to be ignored.
  explicit NewestRecord(int fd);

  void put(const CameraFacts& facts, const PreviewPicture& picture);
  void put(const CameraStatus& status);
  // Writes what the descriptor takes now; put() does so too.
  void flush();

  bool is_closed() const { return is_closed_; }
  std::uint64_t left_out() const { return left_out_; }

 private:
  struct Waiting {
    CameraRecordBuffer buffer;
    std::size_t size = 0;  // 0: none
  };
  bool begin_next();

  int fd_;
  bool is_closed_ = false;
  std::uint64_t left_out_ = 0;  // views that a newer one replaced
  std::unique_ptr<Waiting> view_, status_;
  std::unique_ptr<Waiting> going_;      // being written
  std::span<const std::uint8_t> rest_;  // of it
};

}  // namespace dance
