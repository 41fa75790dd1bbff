// Moves a hand by turning the upper and the lower arm: two-bone IK that turns both as little as it
// can, so that nothing twists and a shift of zero changes nothing.
//
// Units/frames: metres in W; the hand keeps its rotation in W.
// Ownership:    plain values, no allocation.
// Threads:      none inside.
// Failure:      a place out of reach is approached; a shift that is not finite is none.
#pragma once

#include "core/pose/kinematics.h"

namespace dance {

constexpr std::array<Limb, 2> kArms{kLeftArm, kRightArm};

// `frames` are those of the pose and are kept so. Returns the distance that is left.
float move_hand(std::size_t side, const Eigen::Vector3f& shift_W_m, Pose& pose, BodyFrames& frames);

}  // namespace dance
