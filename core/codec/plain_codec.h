// The plain codec: each bone's rotation in 48 bits; every frame is intra. Its errors are bounded:
// 0.0087° a bone, 0.05 mm in the hips, 1/510 in confidence; musical time and presence are exact.
// Bones that were not measured and stand at rest cost nothing.
//
// Units/frames: layout in docs/wire-format.md.
// Ownership:    no state.
// Threads:      none inside.
// Failure:      as core/codec/pose_codec.h says; encode() refuses what is not is_valid().
#pragma once

#include "core/codec/pose_codec.h"

namespace dance {

class PlainEncoder final : public PoseEncoder {
 public:
  CodecName name() const override { return {CodecId::kPlain, 0}; }
  std::size_t encode(const Pose& pose, std::span<std::uint8_t> payload) override;
};

class PlainDecoder final : public PoseDecoder {
 public:
  CodecName name() const override { return {CodecId::kPlain, 0}; }
  DecodeResult decode(std::uint32_t sequence, std::span<const std::uint8_t> payload,
                      Pose& pose) override;
};

// Skeletons have one format whatever the pose codec; the result of decode_skeleton() is_valid().
// Offsets in steps of 0.1 mm; the skeleton's version travels along.
constexpr std::size_t kSkeletonPayload = 4 + 3 * 2 * (kBoneCount + kTipCount);
std::size_t encode_skeleton(const Skeleton& skeleton, std::span<std::uint8_t> payload);
bool decode_skeleton(std::span<const std::uint8_t> payload, Skeleton& skeleton);

}  // namespace dance
