// The lossless codec: every bit of a pose's rotations, hips, presence, confidence and musical time,
// for recordings and ground truth. Real dance takes about a third of the raw size. Each frame
// depends on all frames since the last intra frame, so a stream is read in order from an intra
// frame on; not for networks with loss.
//
// Units/frames: as in core/pose/pose.h; sequence, clock and times travel outside. Layout in
//               docs/codec.md.
// Ownership:    both own their adaptive state (about 70 KB), made once; encode() and decode() never
//               allocate.
// Threads:      none inside; one owner.
// Failure:      encode() gives 0 bytes where they do not fit, and restarts. decode() never gives a
//               pose for a frame whose predecessor is missing or damaged. Its result equals the
//               encoder's input, is_valid() or not.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include "core/codec/pose_codec.h"
#include "core/pose/pose.h"

namespace dance {

// Longest frame, whatever bits it holds.
constexpr std::size_t kMaxLosslessPayload = 2048;
// Size of the same content in memory, without presence, confidence and music.
constexpr std::size_t kRawPose_bytes = kBoneCount * 16 + 12;

class LosslessModel;
class LosslessOpening;

class LosslessEncoder {
 public:
  LosslessEncoder();
  ~LosslessEncoder();
  LosslessEncoder(LosslessEncoder&&) noexcept;
  LosslessEncoder& operator=(LosslessEncoder&&) noexcept;

  std::size_t encode(const Pose& pose, std::span<std::uint8_t> out);
  // The next frame is an intra frame.
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

  // Sequence, clock and times of `pose` stay as they are. Anything but kPose leaves the rest
  // unspecified. After kMalformed only an intra frame decodes.
  DecodeResult decode(std::span<const std::uint8_t> payload, Pose& pose);
  void restart();

 private:
  std::unique_ptr<LosslessModel> model_;
};

// Reads of a stream only what is said beside the body, at a fortieth of the cost: presence and
// music. A damaged frame shows only in the decoder.
class LosslessGlance {
 public:
  LosslessGlance();
  ~LosslessGlance();
  LosslessGlance(LosslessGlance&&) noexcept;
  LosslessGlance& operator=(LosslessGlance&&) noexcept;

  // Sets presence and music of `pose`; kPose, kReferenceMissing or kMalformed as decode() does.
  DecodeResult look(std::span<const std::uint8_t> payload, Pose& pose);

 private:
  std::unique_ptr<LosslessOpening> opening_;
  std::uint64_t frames_ = 0;  // since the intra frame; 0: none came
};

}  // namespace dance
