// Which bones a point of a figure's surface follows, and how much: a bone takes over from its
// parent across the joint between them, gradually, so that skin and cloth bend without a gap.
//
// Units/frames: metres, W, T-pose as in figure_part.h. Joint b is bone b, kBoneCount + f is finger
//               bone f.
// Ownership:    refers to nothing.
// Threads:      none inside; const use from any.
// Failure:      none; the weights of every point add up to 255.
#pragma once

#include <array>
#include <cstdint>

#include "formats/body/figure_builder.h"
#include "formats/body/hand_layout.h"

namespace dance {

struct SkinWeights {
  std::array<std::uint8_t, 4> joints{};
  std::array<std::uint8_t, 4> weights{255, 0, 0, 0};  // of 255
};

class SkinWeighting {
 public:
  explicit SkinWeighting(const Skeleton& skeleton);

  SkinWeights weights_at(const Eigen::Vector3f& place_m, const FigureLayer& layer) const;

 private:
  static constexpr std::size_t kJoints = kBoneCount + kFingerBoneCount;
  using Shares = std::array<float, kJoints>;

  // 0 before the joint of `bone`, 1 beyond it, in between over 2 · half_m along `direction`.
  float beyond(Bone bone, const Eigen::Vector3f& direction, const Eigen::Vector3f& place_m,
               float half_m, float shift_m = 0.0f) const;
  void share_upper_body(const Eigen::Vector3f& place_m, Shares& shares) const;
  void share_trunk(const Eigen::Vector3f& place_m, float share, Shares& shares) const;
  void share_body(const Eigen::Vector3f& place_m, Shares& shares) const;
  void share_neck(const Eigen::Vector3f& place_m, Shares& shares) const;
  float share_arm(const Eigen::Vector3f& place_m, bool left, Shares& shares) const;
  float share_leg(const Eigen::Vector3f& place_m, bool left, float share, Shares& shares) const;
  void share_skirt(const Eigen::Vector3f& place_m, Shares& shares) const;
  void share_finger(const Eigen::Vector3f& place_m, std::size_t finger, Shares& shares) const;

  TposePlaces places_;
  HandLayout layout_;
};

}  // namespace dance
