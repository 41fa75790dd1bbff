// The poses or the hands of one channel in a packed log: the fields beside the body as differences
// in variable-length numbers, then the lossless codec's frame; of hands one frame for each, as if
// its bones were the first of a body. Every bit is restored, also of invalid times and NaN.
//
// Units/frames: as pose_t and hands_t have them.
// Ownership:    each owns its codec's state (70 KB, of hands twice); never allocates after
//               construction.
// Threads:      none inside; one owner.
// Failure:      pack() gives 0 where a message does not fit `out`, and restarts. unpack() of a
//               frame whose predecessor is missing is kReferenceMissing and changes nothing; after
//               damage only an intra frame decodes. A damaged frame may also give a wrong pose: the
//               log's checksum detects it, and restart() is due.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "core/bus/encode.h"
#include "core/codec/lossless/lossless_codec.h"

namespace dance {

enum class MotionType : std::uint8_t { kPose, kHands };

// A pose_t or a hands_t, every bit of it.
struct RawMotion {
  MotionType type = MotionType::kPose;
  RawPose pose;  // of hands: the left one, and the fields beside the bones
  Pose right_hand;
};
std::size_t encode(const RawMotion& motion, MessageBuffer& buffer);
// False for other types.
bool decode_unchecked(const void* data, std::size_t size, RawMotion& motion);

// Longest header: the byte of flags, nine numbers and the left hand's length.
constexpr std::size_t kMaxMotionHead_bytes = 1 + 9 * 10 + 2;
constexpr std::size_t kMaxPackedMotion_bytes = kMaxMotionHead_bytes + 2 * kMaxLosslessPayload;

// The state that headers refer to.
struct MotionHead {
  std::uint64_t clock_id = 0;
  std::uint64_t capture_time_us = 0;
  std::uint64_t step_us = 0;  // of capture times
  std::uint32_t sequence = 0;
  std::array<std::uint64_t, kHopCount> gap_us{};  // of each hop to the step before it
};

// Reads of a packed pose what is said beside the body: sequence, clock, times, presence and music.
// For those who look through a log, or pass over a part of it. A frame whose predecessor is missing
// is kReferenceMissing and changes nothing; damage within a frame does not show.
class MotionGlance {
 public:
  DecodeResult look(bool is_key, std::span<const std::uint8_t> packed, RawPose& raw);

 private:
  LosslessGlance body_;
  MotionHead head_;
};

class MotionPacker {
 public:
  explicit MotionPacker(MotionType type);

  MotionType type() const { return type_; }
  // True before the first message and after restart(): the next frame is an intra frame.
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
