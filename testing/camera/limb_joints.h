// The twelve joints of the limbs that evaluations and tests judge: the network's point, and the
// bone whose origin is the same joint; left and right of each, in this order.
//
// Units/frames: metres in W, as core/pose/kinematics.h has it.
// Ownership:    constants and plain values.
// Threads:      none inside.
// Failure:      none.
#pragma once

#include <Eigen/Core>
#include <array>

#include "core/pose/kinematics.h"
#include "producers/camera/body_landmarks.h"

namespace dance {

struct LimbJoint {
  Landmark landmark;
  Bone bone;
};
constexpr std::array<LimbJoint, 12> kLimbJoints{{
    {Landmark::kLeftShoulder, Bone::kLeftUpperArm},
    {Landmark::kRightShoulder, Bone::kRightUpperArm},
    {Landmark::kLeftElbow, Bone::kLeftLowerArm},
    {Landmark::kRightElbow, Bone::kRightLowerArm},
    {Landmark::kLeftWrist, Bone::kLeftHand},
    {Landmark::kRightWrist, Bone::kRightHand},
    {Landmark::kLeftHip, Bone::kLeftUpperLeg},
    {Landmark::kRightHip, Bone::kRightUpperLeg},
    {Landmark::kLeftKnee, Bone::kLeftLowerLeg},
    {Landmark::kRightKnee, Bone::kRightLowerLeg},
    {Landmark::kLeftAnkle, Bone::kLeftFoot},
    {Landmark::kRightAnkle, Bone::kRightFoot},
}};
// Where the left one of a pair is; the right one follows.
constexpr std::size_t kWristsAt = 4, kHipsAt = 6;

using LimbPlaces = std::array<Eigen::Vector3d, kLimbJoints.size()>;

inline LimbPlaces limb_places(const BodyFrames& frames) {
  LimbPlaces places;
  for (std::size_t i = 0; i < places.size(); ++i)
    places[i] = frames.position(kLimbJoints[i].bone).cast<double>();
  return places;
}
inline Eigen::Vector3d middle_of_hips(const LimbPlaces& places) {
  return 0.5 * (places[kHipsAt] + places[kHipsAt + 1]);
}

}  // namespace dance
