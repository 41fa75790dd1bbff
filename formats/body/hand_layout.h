// HandLayout: where the bones of the fingers lie in a hand at rest, for files that need lengths of
// fingers: a Skeleton knows only how long the hand is. An average hand, scaled to the dancer's.
//
// Units/frames: metres; T-pose, axes of W. offset_m[f] is the origin of finger bone f from its
//               parent's, of a finger's first bone from the hand's; tip_m[k] is the end of finger k
//               (order of kFingerBones) from its last bone's origin.
// Ownership:    plain value.
// Threads:      none inside.
// Failure:      none; a hand without length gets that of an average body.
#pragma once

#include <Eigen/Core>
#include <array>
#include <string>

#include "core/pose/skeleton.h"

namespace dance {

constexpr std::size_t kFingerCount = 10;
constexpr std::size_t kBonesOfAFinger = 3;
static_assert(kFingerCount * kBonesOfAFinger == kFingerBoneCount);

struct HandLayout {
  std::array<Eigen::Vector3f, kFingerBoneCount> offset_m;
  std::array<Eigen::Vector3f, kFingerCount> tip_m;
};

// The middle fingers end at the tips of the hands, Tip::kLeftHand and Tip::kRightHand.
HandLayout hand_layout(const Skeleton& skeleton);

// The hand that a finger bone belongs to.
constexpr Bone hand_of_finger_bone(std::size_t finger_bone) {
  return finger_bone < kFingerBoneCount / 2 ? Bone::kLeftHand : Bone::kRightHand;
}
// Half as thick as a finger bone is at its origin, for a hand of the given length.
float finger_radius_m(std::size_t finger_bone, float hand_length_m);

}  // namespace dance
