// The lossless codec: every bit of a pose's rotations, hips, presence, confidence and musical time,
// for recordings and for truth to compare with. Real dance takes about a third of the raw size.
// Each frame leans on all frames since the last key frame, so a stream is read from a key frame on,
// in order; it is no codec for a network that loses.
//
// Units/frames: as in core/pose/pose.h; sequence, clock and times travel outside. Layout in
//               docs/codec.md.
// Ownership:    both own what they learnt (about 70 KB), made once; encode() and decode() never
//               allocate.
// Threads:      none inside; one owner.
// Failure:      encode() gives 0 bytes where they do not fit, and begins anew. decode() never gives
//               a pose for a frame whose predecessor it has not seen, or had damaged. What it gives
//               is what the encoder was given: is_valid() or not.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include "core/codec/pose_codec.h"
#include "core/pose/pose.h"

namespace dance {

// No frame is longer, whatever bits it holds.
constexpr std::size_t kMaxLosslessPayload = 2048;
// What the same content costs as it lies in memory, presence, confidence and music left out.
constexpr std::size_t kRawPose_bytes = kBoneCount * 16 + 12;

class LosslessModel;

class LosslessEncoder {
 public:
  LosslessEncoder();
  ~LosslessEncoder();
  LosslessEncoder(LosslessEncoder&&) noexcept;
  LosslessEncoder& operator=(LosslessEncoder&&) noexcept;

  std::size_t encode(const Pose& pose, std::span<std::uint8_t> out);
  // The next frame is a key frame.
  void restart();

 private:
  std::unique_ptr<LosslessModel> model_;
};

class LosslessDecoder {
 public:
  LosslessDecoder();
  ~LosslessDecoder();
  LosslessDecoder(LosslessDecoder&&) noexcept;
  LosslessDecoder& operator=(LosslessDecoder&&) noexcept;

  // Sequence, clock and times of `pose` stay as they are. Anything but kPose leaves the rest as it
  // may be. After kMalformed only a key frame is understood.
  DecodeResult decode(std::span<const std::uint8_t> payload, Pose& pose);
  void restart();

 private:
  std::unique_ptr<LosslessModel> model_;
};

}  // namespace dance
