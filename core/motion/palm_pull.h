// Draws the palms of a predicted body towards places that are known better, and lets the whole
// chain from the hips to the hand take its part: each joint as far as predictions of it are
// usually wrong. An elbow turns about its hinge only.
//
// Units/frames: metres in W; a palm lies half way from the wrist to the end of the hand.
// Ownership:    plain values, no allocation. 2 us.
// Threads:      none inside.
// Failure:      none: a place out of reach is approached; a pull that is not finite is none.
// Source:       the gain of a Kalman filter whose state is the body's joints; two steps of
//               Gauss-Newton.
#pragma once

#include <array>

#include "core/pose/kinematics.h"

namespace dance {

constexpr std::array<Bone, 2> kHandBones{Bone::kLeftHand, Bone::kRightHand};

Eigen::Vector3f palm_of(const Skeleton& skeleton, const BodyFrames& frames, std::size_t side);

struct PalmPull {
  Eigen::Vector3f shift_W_m = Eigen::Vector3f::Zero();  // to where the palm should be
  float share = 0.0f;  // of the shift that is right: 0 leaves the arm free, 1 brings the palm there
};

// Returns whether the pose was changed. Hips are moved along the floor, not lifted.
bool pull_palms(const Skeleton& skeleton, const std::array<PalmPull, 2>& pulls, Pose& pose);

}  // namespace dance
