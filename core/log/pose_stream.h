// The poses of one channel as a packed log holds them: what pose_t carries beside the body, as
// differences in variable-length numbers, then the lossless codec's frame. Every bit comes back,
// whatever it says: times that no clock shows, numbers that are none.
//
// Units/frames: as pose_t has them.
// Ownership:    each owns what its codec learnt (70 KB), made once; nothing is allocated after.
// Threads:      none inside; one owner.
// Failure:      pack() gives 0 where a pose does not fit `out`, and begins anew. unpack() tells what
//               refers to a pose that it has not seen (kReferenceMissing, which changes nothing) from
//               damage, after which only a key frame is understood. A damaged frame may also give a
//               wrong pose: the log's checksum tells, and restart() is due then.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "core/bus/encode.h"
#include "core/codec/lossless_codec.h"

namespace dance {

// The head's byte of marks and its nine numbers, at the longest.
constexpr std::size_t kMaxPoseHead_bytes = 1 + 9 * 10;
constexpr std::size_t kMaxStreamPose_bytes = kMaxPoseHead_bytes + kMaxLosslessPayload;

// What the next head is told by.
struct PoseHead {
  std::uint64_t clock_id = 0;
  std::uint64_t capture_time_us = 0;
  std::uint64_t step_us = 0;  // of capture times
  std::uint32_t sequence = 0;
  std::array<std::uint64_t, kHopCount> gap_us{};  // of each hop to the step before it
};

class PoseStreamPacker {
 public:
  // True as long as nothing was packed, and after restart(): the next pose is a key frame.
  bool is_at_key() const { return is_at_key_; }
  void restart();
  // Bytes written.
  std::size_t pack(const RawPose& raw, std::span<std::uint8_t> out);

 private:
  LosslessEncoder encoder_;
  PoseHead head_;
  bool is_at_key_ = true;
};

class PoseStreamUnpacker {
 public:
  void restart();
  // kPose, kReferenceMissing or kMalformed.
  DecodeResult unpack(bool is_key, std::span<const std::uint8_t> packed, RawPose& raw);

 private:
  LosslessDecoder decoder_;
  PoseHead head_;
};

}  // namespace dance
