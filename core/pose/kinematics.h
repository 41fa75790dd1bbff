// Forward kinematics of the canonical skeleton, and two-bone IK for arms and legs.
//
// Units/frames: metres in W; R_WB is a bone's rotation in W.
// Ownership:    plain values, no allocation.
// Threads:      none inside.
// Failure:      solve_two_bone() stretches towards a target out of reach and returns the distance.
#pragma once

#include <Eigen/Geometry>
#include <array>

#include "core/pose/pose.h"
#include "core/pose/skeleton.h"

namespace dance {

// Every bone's place and rotation in W, and the five ends of the body.
struct BodyFrames {
  std::array<Eigen::Vector3f, kBoneCount> p_WB_m;
  BoneRotations R_WB;
  std::array<Eigen::Vector3f, kTipCount> p_WT_m;

  const Eigen::Vector3f& position(Bone bone) const { return p_WB_m[index_of(bone)]; }
  const Eigen::Vector3f& tip(Tip tip) const { return p_WT_m[static_cast<std::size_t>(tip)]; }
};

// p_WB = p_WP + R_WP · offset_B,  R_WB = R_WP · R_PB.
void forward_kinematics(const Skeleton& skeleton, const Pose& pose, BodyFrames& frames);

// The two bones of an arm or a leg: upper (shoulder, hip), lower (elbow, knee) and the end (wrist,
// ankle).
struct Limb {
  Bone upper;
  Bone lower;
  Bone end;
};
constexpr Limb kLeftArm{Bone::kLeftUpperArm, Bone::kLeftLowerArm, Bone::kLeftHand};
constexpr Limb kRightArm{Bone::kRightUpperArm, Bone::kRightLowerArm, Bone::kRightHand};
constexpr Limb kLeftLeg{Bone::kLeftUpperLeg, Bone::kLeftLowerLeg, Bone::kLeftFoot};
constexpr Limb kRightLeg{Bone::kRightUpperLeg, Bone::kRightLowerLeg, Bone::kRightFoot};

// Turns the limb's upper and lower bone so that its end comes to target_W_m, bending towards pole_W
// (a direction: forward for knees, backward and out for elbows). Local rotations are written to the
// pose; the end bone's rotation in W is kept as R_WEnd. The parents' frames in `frames` must be
// current; the limb's own are updated. Returns the distance left to the target, 0 when it was
// reached.
float solve_two_bone(const Skeleton& skeleton, const Limb& limb, const Eigen::Vector3f& target_W_m,
                     const Eigen::Vector3f& pole_W, const Eigen::Quaternionf& R_WEnd, Pose& pose,
                     BodyFrames& frames);

}  // namespace dance
