// BodyGuide: says of a dancer of whom few points are known how the whole body probably is. What is
// measured is put right afterwards (body_fit.h).
//
// Units/frames: W, metres.
// Ownership:    guides are owned by TrackerBody; a guess is a plain value.
// Threads:      none inside; one owner.
// Failure:      none; wants the head among the places.
#pragma once

#include "core/pose/kinematics.h"
#include "producers/trackers/tracker_mounts.h"

namespace dance {

struct BodyGuess {
  BoneRotations R_WB = identity_rotations();
  Eigen::Vector3f p_WH_m = Eigen::Vector3f::Zero();
  std::array<Eigen::Vector3f, 2> ankles_W_m{Eigen::Vector3f::Zero(), Eigen::Vector3f::Zero()};
  // The probability that each foot stands.
  std::array<float, 2> stands{1.0f, 1.0f};

  Eigen::Quaternionf& R(Bone bone) { return R_WB[index_of(bone)]; }
  const Eigen::Quaternionf& R(Bone bone) const { return R_WB[index_of(bone)]; }
};

class BodyGuide {
 public:
  virtual ~BodyGuide() = default;
  virtual void reset() = 0;
  // `seconds` since the last call; 0 at first. Never allocates.
  virtual void guess(const Skeleton& skeleton, const BonePlaces& bones, float seconds,
                     BodyGuess& guess) = 0;
};

}  // namespace dance
