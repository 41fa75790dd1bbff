// A dancer as Motive's skeleton, for tests.
//
// Units/frames: W is Motive's space with Y up.
// Ownership:    returns values.
// Threads:      none inside.
// Failure:      none.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string_view>

#include "formats/natnet/natnet_packet.h"
#include "producers/receive/joint_figure.h"

namespace dance {

enum class NatNetNames { kMotive, kFbx, kBvh };

struct NatNetJoint {
  std::string_view motive;
  std::string_view fbx;
  std::string_view bvh;
  Bone bone;
  int parent;  // index; -1 for the hips
};
constexpr std::array<NatNetJoint, 21> kNatNetJoints{{
    {"Hip", "Hips", "Hips", Bone::kHips, -1},
    {"Ab", "Spine", "Chest", Bone::kSpine, 0},
    {"Chest", "Spine1", "Chest2", Bone::kUpperChest, 1},
    {"Neck", "Neck", "Neck", Bone::kNeck, 2},
    {"Head", "Head", "Head", Bone::kHead, 3},
    {"LShoulder", "LeftShoulder", "LeftCollar", Bone::kLeftShoulder, 2},
    {"LUArm", "LeftArm", "LeftShoulder", Bone::kLeftUpperArm, 5},
    {"LFArm", "LeftForeArm", "LeftElbow", Bone::kLeftLowerArm, 6},
    {"LHand", "LeftHand", "LeftWrist", Bone::kLeftHand, 7},
    {"RShoulder", "RightShoulder", "RightCollar", Bone::kRightShoulder, 2},
    {"RUArm", "RightArm", "RightShoulder", Bone::kRightUpperArm, 9},
    {"RFArm", "RightForeArm", "RightElbow", Bone::kRightLowerArm, 10},
    {"RHand", "RightHand", "RightWrist", Bone::kRightHand, 11},
    {"LThigh", "LeftUpLeg", "LeftHip", Bone::kLeftUpperLeg, 0},
    {"LShin", "LeftLeg", "LeftKnee", Bone::kLeftLowerLeg, 13},
    {"LFoot", "LeftFoot", "LeftAnkle", Bone::kLeftFoot, 14},
    {"LToe", "LeftToeBase", "LeftToe", Bone::kLeftToes, 15},
    {"RThigh", "RightUpLeg", "RightHip", Bone::kRightUpperLeg, 0},
    {"RShin", "RightLeg", "RightKnee", Bone::kRightLowerLeg, 17},
    {"RFoot", "RightFoot", "RightAnkle", Bone::kRightFoot, 18},
    {"RToe", "RightToeBase", "RightToe", Bone::kRightToes, 19},
}};

// The offsets are those of the figure as it stands there.
inline NatNetModel natnet_model(const FigureFrame& figure, std::string_view name, std::int32_t id,
                                NatNetNames names = NatNetNames::kMotive) {
  NatNetModel model;
  (void)model.name.assign(name);
  model.id = id;
  for (std::size_t j = 0; j < kNatNetJoints.size(); ++j) {
    const NatNetJoint& joint = kNatNetJoints[j];
    NatNetModelBone bone;
    (void)bone.name.assign(names == NatNetNames::kMotive ? joint.motive
                           : names == NatNetNames::kFbx  ? joint.fbx
                                                         : joint.bvh);
    bone.id = static_cast<std::int32_t>(j + 1);
    bone.parent_id = joint.parent + 1;
    if (joint.parent >= 0) {
      const auto above = index_of(kNatNetJoints[static_cast<std::size_t>(joint.parent)].bone);
      bone.offset_m = figure.R_WB[above].conjugate() *
                      (figure.p_WB_m[index_of(joint.bone)] - figure.p_WB_m[above]);
    }
    (void)model.bones.try_push(bone);
  }
  return model;
}

inline NatNetSkeleton natnet_skeleton(const FigureFrame& figure, std::int32_t id, bool in_parents) {
  NatNetSkeleton skeleton;
  skeleton.id = id;
  for (std::size_t j = 0; j < kNatNetJoints.size(); ++j) {
    const NatNetJoint& joint = kNatNetJoints[j];
    const std::size_t b = index_of(joint.bone);
    NatNetBone bone;
    bone.id = static_cast<std::int32_t>(j + 1);
    bone.is_tracked = true;
    bone.p_m = figure.p_WB_m[b];
    bone.R = figure.R_WB[b];
    if (in_parents && joint.parent >= 0) {
      const auto above = index_of(kNatNetJoints[static_cast<std::size_t>(joint.parent)].bone);
      bone.p_m = figure.R_WB[above].conjugate() * (figure.p_WB_m[b] - figure.p_WB_m[above]);
      bone.R = figure.R_WB[above].conjugate() * figure.R_WB[b];
    }
    (void)skeleton.bones.try_push(bone);
  }
  return skeleton;
}

}  // namespace dance
