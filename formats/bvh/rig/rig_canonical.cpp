#include "formats/bvh/rig/rig_canonical.h"

#include <Eigen/Geometry>
#include <algorithm>

#include "core/pose/bone.h"

namespace dance {
namespace {

using Eigen::Vector3d;

constexpr double kInTpose = 0.95;  // cosine: within 18° of a limb's direction in T-pose
// Bounds of a leg in metres, from thigh to ankle.
constexpr double kShortestLeg_m = 0.2;
constexpr double kLongestLeg_m = 1.6;

std::string_view name_of_parent(const Bvh& bvh, const BvhJoint& joint) {
  return joint.parent < 0 ? std::string_view()
                          : bvh.joints[static_cast<std::size_t>(joint.parent)].name;
}

std::string_view expected_parent(std::size_t bone) {
  return kBones[bone].parent < 0 ? std::string_view()
                                 : kBones[static_cast<std::size_t>(kBones[bone].parent)].name;
}

std::string_view expected_parent_of_finger(std::size_t finger) {
  if (kFingerBones[finger].parent >= 0)
    return kFingerBones[static_cast<std::size_t>(kFingerBones[finger].parent)].name;
  return finger < kFingerBoneCount / 2 ? "leftHand" : "rightHand";
}

bool is_end(const Bvh& bvh, std::size_t joint) {
  const BvhJoint& end = bvh.joints[joint];
  const bool is_leaf = std::none_of(bvh.joints.begin(), bvh.joints.end(), [&](const BvhJoint& j) {
    return j.parent == static_cast<int>(joint);
  });
  return is_leaf && end.name == std::string(name_of_parent(bvh, end)) + "End";
}

}  // namespace

bool is_canonical(const Bvh& bvh) {
  constexpr std::size_t kMostJoints = 2 * (kBoneCount + kFingerBoneCount);
  if (bvh.joints.size() > kMostJoints) return false;
  std::array<const BvhJoint*, kBoneCount> bones{};
  for (std::size_t j = 0; j < bvh.joints.size(); ++j) {
    const BvhJoint& joint = bvh.joints[j];
    if (const auto bone = find_bone(joint.name)) {
      const BvhJoint*& known = bones[index_of(*bone)];
      if (known || name_of_parent(bvh, joint) != expected_parent(index_of(*bone))) return false;
      known = &joint;
      continue;
    }
    const auto* finger =
        std::find_if(kFingerBones.begin(), kFingerBones.end(),
                     [&](const BoneInfo& info) { return info.name == joint.name; });
    const bool is_finger =
        finger != kFingerBones.end() &&
        name_of_parent(bvh, joint) ==
            expected_parent_of_finger(static_cast<std::size_t>(finger - kFingerBones.begin()));
    if (!is_finger && !is_end(bvh, j)) return false;
  }
  if (std::find(bones.begin(), bones.end(), nullptr) != bones.end()) return false;
  const auto lies_along = [&](Bone bone, const Vector3d& direction) {
    const Vector3d& offset = bones[index_of(bone)]->offset;
    return offset.dot(direction) > kInTpose * offset.norm();
  };
  const auto leg_m = [&](Bone shin, Bone foot) {
    return bones[index_of(shin)]->offset.norm() + bones[index_of(foot)]->offset.norm();
  };
  const double left_m = leg_m(Bone::kLeftLowerLeg, Bone::kLeftFoot);
  const double right_m = leg_m(Bone::kRightLowerLeg, Bone::kRightFoot);
  return std::min(left_m, right_m) > kShortestLeg_m && std::max(left_m, right_m) < kLongestLeg_m &&
         lies_along(Bone::kLeftLowerLeg, -Vector3d::UnitY()) &&
         lies_along(Bone::kRightLowerLeg, -Vector3d::UnitY()) &&
         lies_along(Bone::kLeftFoot, -Vector3d::UnitY()) &&
         lies_along(Bone::kRightFoot, -Vector3d::UnitY()) &&
         lies_along(Bone::kLeftLowerArm, Vector3d::UnitX()) &&
         lies_along(Bone::kLeftHand, Vector3d::UnitX()) &&
         lies_along(Bone::kRightLowerArm, -Vector3d::UnitX()) &&
         lies_along(Bone::kRightHand, -Vector3d::UnitX());
}

}  // namespace dance
