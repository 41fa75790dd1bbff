// The poses or the hands of one channel as a packed log holds them: what the message carries beside
// the body, as differences in variable-length numbers, then the lossless codec's frame; of hands
// one frame for each, as if its bones were the first of a body. Every bit comes back, whatever it
// says: times that no clock shows, numbers that are none.
//
// Units/frames: as pose_t and hands_t have them.
// Ownership:    each owns what its codec learnt (70 KB, of hands twice), made once; nothing is
//               allocated after.
// Threads:      none inside; one owner.
// Failure:      pack() gives 0 where a message does not fit `out`, and begins anew. unpack() tells
//               what refers to a message that it has not seen (kReferenceMissing, which changes
//               nothing) from damage, after which only a key frame is understood. A damaged frame
//               may also give a wrong pose: the log's checksum tells, and restart() is due then.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "core/bus/encode.h"
#include "core/codec/lossless_codec.h"

namespace dance {

enum class MotionType : std::uint8_t { kPose, kHands };

// A pose_t or a hands_t, every bit of it.
struct RawMotion {
  MotionType type = MotionType::kPose;
  RawPose pose;  // of hands: the left one, and what stands beside the bones
  Pose right_hand;
};
std::size_t encode(const RawMotion& motion, MessageBuffer& buffer);
// False for what is neither.
bool decode_unchecked(const void* data, std::size_t size, RawMotion& motion);

// The head's byte of marks, its nine numbers and the left hand's length, at the longest.
constexpr std::size_t kMaxMotionHead_bytes = 1 + 9 * 10 + 2;
constexpr std::size_t kMaxPackedMotion_bytes = kMaxMotionHead_bytes + 2 * kMaxLosslessPayload;

// What the next head is told by.
struct MotionHead {
  std::uint64_t clock_id = 0;
  std::uint64_t capture_time_us = 0;
  std::uint64_t step_us = 0;  // of capture times
  std::uint32_t sequence = 0;
  std::array<std::uint64_t, kHopCount> gap_us{};  // of each hop to the step before it
};

class MotionPacker {
 public:
  explicit MotionPacker(MotionType type);

  MotionType type() const { return type_; }
  // True as long as nothing was packed, and after restart(): the next frame is a key frame.
  bool is_at_key() const { return is_at_key_; }
  void restart();
  // Bytes written. `motion` is of this packer's type.
  std::size_t pack(const RawMotion& motion, std::span<std::uint8_t> out);

 private:
  MotionType type_;
  LosslessEncoder encoder_;
  std::optional<LosslessEncoder> right_hand_;
  MotionHead head_;
  bool is_at_key_ = true;
};

class MotionUnpacker {
 public:
  explicit MotionUnpacker(MotionType type);

  MotionType type() const { return type_; }
  void restart();
  // kPose, kReferenceMissing or kMalformed.
  DecodeResult unpack(bool is_key, std::span<const std::uint8_t> packed, RawMotion& motion);

 private:
  MotionType type_;
  LosslessDecoder decoder_;
  std::optional<LosslessDecoder> right_hand_;
  MotionHead head_;
};

}  // namespace dance
