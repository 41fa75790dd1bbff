// Collects records for one receiver until they share a datagram: as many as fit, or as long as the
// first of them may wait.
//
// Units/frames: MonoTime of the owner's clock; near_us is about now by the server's clock.
// Ownership:    owns a copy of the records' bytes, of fixed size; never allocates.
// Threads:      none inside.
// Failure:      add() asserts that has_room_for() was asked.
#pragma once

#include <array>
#include <cstdint>

#include "core/base/time.h"
#include "tunnel/session/held_frames.h"
#include "tunnel/wire/wire_records.h"

namespace dance {

// Whether a receiver that has these frames can tell the record's whole numbers from the low bits.
bool is_narrow_for(const HeldFrames& frames, const wire::Record& record);

class RecordBundler {
 public:
  bool is_empty() const { return size_ == 0; }
  // Bytes that the header may take beside what is here.
  std::size_t room() const { return wire::kMaxRecordsBody - size_; }
  bool has_room_for(const wire::Record& record) const {
    return room() >= wire::kMaxRecordHeader + record.payload.size();
  }
  // The first record decides when all are due, and what their times are told from.
  void add(const wire::Record& record, bool is_narrow, std::int64_t near_us, MonoTime due);
  // A pose is new here, not sent once more: those are counted.
  void count_pose() { ++poses_; }

  MonoTime due() const { return due_; }
  // Full of what can come, or has waited long enough. `expected`: how many poses can come before
  // one dancer sends the next.
  bool is_due(MonoTime now, std::size_t expected) const {
    return now >= due_ || poses_ >= expected;
  }
  // The whole datagram's bytes; nothing is left here.
  wire::Bytes write(const wire::RecordsHeader& header, std::span<std::uint8_t> buffer);
  void clear() { size_ = 0; }

 private:
  std::array<std::uint8_t, wire::kMaxRecordsBody> bytes_;
  std::size_t size_ = 0;
  std::size_t poses_ = 0;
  wire::RecordChain chain_;
  MonoTime due_;
};

}  // namespace dance
