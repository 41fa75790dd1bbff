// Bones by the names that many tools give them, and which way figures face.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "formats/avatar/read/avatar_nodes.h"
#include "tests/formats/avatar/read_well.h"

namespace dance {
namespace {

using test::name_of_node;
using test::TinyAvatar;
using test::ToolNames;

std::string error_of(const test::Bytes& bytes) {
  const auto read = read_avatar(bytes);
  return read ? "was read" : read.error().what;
}

AvatarModel read_named(const ToolNames& names) {
  TinyAvatar avatar(names);
  avatar.add_mesh(avatar.square());
  return test::model_of(avatar);
}

std::string name_of(const AvatarModel& model, Bone bone) {
  return name_of_node(model, model.node_of(bone));
}

std::string sided(std::string pattern, const std::string& side) {
  if (const auto at = pattern.find('%'); at != pattern.npos) pattern.replace(at, 1, side);
  return pattern;
}

struct Tool {
  const char* tool;
  ToolNames names;
  std::array<const char*, 3> spine;  // spine, chest, upper chest
  const char* hips = nullptr;
};

std::vector<Tool> tools() {
  std::vector<Tool> all;
  ToolNames mixamo;
  mixamo.left = "Left";
  mixamo.right = "Right";
  mixamo.trunk = {"mixamorig:Hips", "mixamorig:Spine", "mixamorig:Spine1", "mixamorig:Spine2"};
  mixamo.neck = {"mixamorig:Neck", "mixamorig:Head"};
  mixamo.shoulder = "mixamorig:%Shoulder";
  mixamo.upper_arm = "mixamorig:%Arm";
  mixamo.lower_arm = "mixamorig:%ForeArm";
  mixamo.hand = "mixamorig:%Hand";
  mixamo.thigh = "mixamorig:%UpLeg";
  mixamo.shin = "mixamorig:%Leg";
  mixamo.foot = "mixamorig:%Foot";
  mixamo.toes = "mixamorig:%ToeBase";
  mixamo.fingers = {"mixamorig:%HandThumb#", "mixamorig:%HandIndex#", "mixamorig:%HandMiddle#",
                    "mixamorig:%HandRing#", "mixamorig:%HandPinky#"};
  mixamo.of_head = {"mixamorig:LeftEye", "mixamorig:RightEye"};
  all.push_back({"Mixamo", mixamo, {"mixamorig:Spine", "mixamorig:Spine1", "mixamorig:Spine2"}});

  ToolNames unreal;
  unreal.left = "l";
  unreal.right = "r";
  unreal.trunk = {"pelvis", "spine_01", "spine_02", "spine_03", "spine_04", "spine_05"};
  unreal.neck = {"neck_01", "neck_02", "head"};
  unreal.shoulder = "clavicle_%";
  unreal.upper_arm = "upperarm_%";
  unreal.lower_arm = "lowerarm_%";
  unreal.hand = "hand_%";
  unreal.thigh = "thigh_%";
  unreal.shin = "calf_%";
  unreal.foot = "foot_%";
  unreal.toes = "ball_%";
  unreal.fingers = {"thumb_0#_%", "index_0#_%", "middle_0#_%", "ring_0#_%", "pinky_0#_%"};
  unreal.of_head = {"eye_l", "eye_r"};
  all.push_back({"Unreal", unreal, {"spine_01", "spine_03", "spine_05"}});

  ToolNames rigify;
  rigify.left = "L";
  rigify.right = "R";
  rigify.trunk = {"DEF-spine", "DEF-spine.001", "DEF-spine.002", "DEF-spine.003"};
  rigify.neck = {"DEF-spine.004", "DEF-spine.005", "DEF-spine.006"};
  rigify.shoulder = "DEF-shoulder.%";
  rigify.upper_arm = "DEF-upper_arm.%";
  rigify.lower_arm = "DEF-forearm.%";
  rigify.hand = "DEF-hand.%";
  rigify.thigh = "DEF-thigh.%";
  rigify.shin = "DEF-shin.%";
  rigify.foot = "DEF-foot.%";
  rigify.toes = "DEF-toe.%";
  rigify.fingers = {"DEF-thumb.0#.%", "DEF-f_index.0#.%", "DEF-f_middle.0#.%", "DEF-f_ring.0#.%",
                    "DEF-f_pinky.0#.%"};
  rigify.of_head = {"DEF-eye.L", "DEF-eye.R"};
  all.push_back({"Rigify", rigify, {"DEF-spine.001", "DEF-spine.002", "DEF-spine.003"}});

  ToolNames creator;
  creator.left = "L";
  creator.right = "R";
  creator.trunk = {"CC_Base_Hip", "CC_Base_Waist", "CC_Base_Spine01", "CC_Base_Spine02"};
  creator.pelvis = "CC_Base_Pelvis";
  creator.neck = {"CC_Base_NeckTwist01", "CC_Base_NeckTwist02", "CC_Base_Head"};
  creator.shoulder = "CC_Base_%_Clavicle";
  creator.upper_arm = "CC_Base_%_Upperarm";
  creator.lower_arm = "CC_Base_%_Forearm";
  creator.hand = "CC_Base_%_Hand";
  creator.thigh = "CC_Base_%_Thigh";
  creator.shin = "CC_Base_%_Calf";
  creator.foot = "CC_Base_%_Foot";
  creator.toes = "CC_Base_%_ToeBase";
  creator.fingers = {"CC_Base_%_Thumb#", "CC_Base_%_Index#", "CC_Base_%_Mid#", "CC_Base_%_Ring#",
                     "CC_Base_%_Pinky#"};
  creator.of_head = {"CC_Base_L_Eye", "CC_Base_R_Eye"};
  all.push_back(
      {"Character Creator", creator, {"CC_Base_Waist", "CC_Base_Spine01", "CC_Base_Spine02"}});

  ToolNames daz;
  daz.left = "l";
  daz.right = "r";
  daz.trunk = {"hip", "abdomenLower", "abdomenUpper", "chestLower", "chestUpper"};
  daz.pelvis = "pelvis";
  daz.neck = {"neckLower", "neckUpper", "head"};
  daz.shoulder = "%Collar";
  daz.upper_arm = "%ShldrBend";
  daz.lower_arm = "%ForearmBend";
  daz.hand = "%Hand";
  daz.thigh = "%ThighBend";
  daz.shin = "%Shin";
  daz.foot = "%Foot";
  daz.toes = "%Toe";
  daz.fingers = {"%Thumb#", "%Index#", "%Mid#", "%Ring#", "%Pinky#"};
  daz.of_head = {"lEye", "rEye"};
  all.push_back({"Daz", daz, {"abdomenLower", "chestLower", "chestUpper"}});

  ToolNames unity;
  unity.left = "Left";
  unity.right = "Right";
  unity.trunk = {"Hips", "Spine", "Chest", "UpperChest"};
  unity.neck = {"Neck", "Head"};
  unity.shoulder = "%Shoulder";
  unity.upper_arm = "%UpperArm";
  unity.lower_arm = "%LowerArm";
  unity.hand = "%Hand";
  unity.thigh = "%UpperLeg";
  unity.shin = "%LowerLeg";
  unity.foot = "%Foot";
  unity.toes = "%Toes";
  unity.fingers = {"%Thumb#", "%Index#", "%Middle#", "%Ring#", "%Little#"};
  unity.of_head = {"LeftEye", "RightEye"};
  all.push_back({"Unity", unity, {"Spine", "Chest", "UpperChest"}});

  ToolNames vroid;
  vroid.left = "L";
  vroid.right = "R";
  vroid.trunk = {"J_Bip_C_Hips", "J_Bip_C_Spine", "J_Bip_C_Chest", "J_Bip_C_UpperChest"};
  vroid.neck = {"J_Bip_C_Neck", "J_Bip_C_Head"};
  vroid.shoulder = "J_Bip_%_Shoulder";
  vroid.upper_arm = "J_Bip_%_UpperArm";
  vroid.lower_arm = "J_Bip_%_LowerArm";
  vroid.hand = "J_Bip_%_Hand";
  vroid.thigh = "J_Bip_%_UpperLeg";
  vroid.shin = "J_Bip_%_LowerLeg";
  vroid.foot = "J_Bip_%_Foot";
  vroid.toes = "J_Bip_%_ToeBase";
  vroid.fingers = {"J_Bip_%_Thumb#", "J_Bip_%_Index#", "J_Bip_%_Middle#", "J_Bip_%_Ring#",
                   "J_Bip_%_Little#"};
  vroid.of_head = {"J_Adj_L_FaceEye", "J_Adj_R_FaceEye"};
  all.push_back({"VRoid", vroid, {"J_Bip_C_Spine", "J_Bip_C_Chest", "J_Bip_C_UpperChest"}});
  return all;
}

TEST(AvatarBones, NamesOfManyToolsAreUnderstood) {
  for (const Tool& tool : tools()) {
    SCOPED_TRACE(tool.tool);
    const ToolNames& names = tool.names;
    const AvatarModel model = read_named(names);
    ASSERT_FALSE(model.nodes.empty());
    EXPECT_EQ(name_of(model, Bone::kHips), names.trunk.front());
    EXPECT_EQ(name_of(model, Bone::kSpine), tool.spine[0]);
    EXPECT_EQ(name_of(model, Bone::kChest), tool.spine[1]);
    EXPECT_EQ(name_of(model, Bone::kUpperChest), tool.spine[2]);
    EXPECT_EQ(name_of(model, Bone::kNeck), names.neck.front());
    EXPECT_EQ(name_of(model, Bone::kHead), names.neck.back());
    const auto expect = [&](Bone left, Bone right, const std::string& pattern) {
      EXPECT_EQ(name_of(model, left), sided(pattern, names.left));
      EXPECT_EQ(name_of(model, right), sided(pattern, names.right));
    };
    expect(Bone::kLeftShoulder, Bone::kRightShoulder, names.shoulder);
    expect(Bone::kLeftUpperArm, Bone::kRightUpperArm, names.upper_arm);
    expect(Bone::kLeftLowerArm, Bone::kRightLowerArm, names.lower_arm);
    expect(Bone::kLeftHand, Bone::kRightHand, names.hand);
    expect(Bone::kLeftUpperLeg, Bone::kRightUpperLeg, names.thigh);
    expect(Bone::kLeftLowerLeg, Bone::kRightLowerLeg, names.shin);
    expect(Bone::kLeftFoot, Bone::kRightFoot, names.foot);
    expect(Bone::kLeftToes, Bone::kRightToes, names.toes);
    for (std::size_t f = 0; f < kFingerBoneCount; ++f) {
      std::string pattern = sided(names.fingers[f % 15 / 3], f < 15 ? names.left : names.right);
      std::ranges::replace(pattern, '#', static_cast<char>('1' + f % 3));
      EXPECT_EQ(name_of_node(model, model.fingers[f]), pattern);
    }
    EXPECT_EQ(name_of_node(model, model.eyes[0]), names.of_head[0]);
    EXPECT_EQ(name_of_node(model, model.eyes[1]), names.of_head[1]);
  }
}

TEST(AvatarBones, OfASpineOfAnyLengthTheFirstAndTheLastAreUsedAndOneBetween) {
  for (std::size_t length = 1; length <= 6; ++length) {
    ToolNames names;
    names.trunk = {"hips"};
    for (std::size_t s = 1; s <= length; ++s) names.trunk.push_back("spine" + std::to_string(s));
    const AvatarModel model = read_named(names);
    ASSERT_FALSE(model.nodes.empty()) << length;
    EXPECT_EQ(name_of(model, Bone::kSpine), "spine1");
    const std::string last = "spine" + std::to_string(length);
    EXPECT_EQ(name_of(model, Bone::kUpperChest), length >= 3 ? last : "");
    const std::string middle = "spine" + std::to_string(length / 2 + 1);
    EXPECT_EQ(name_of(model, Bone::kChest), length >= 2 ? middle : "");
  }
}

TEST(AvatarBones, WhatIsMissingIsNamed) {
  TinyAvatar avatar;
  auto& nodes = avatar.json["nodes"];
  avatar.json["extensions"]["VRMC_vrm"]["humanoid"]["humanBones"] = {
      {"hips", {{"node", avatar.node("hips")}}}, {"head", {{"node", avatar.node("head")}}}};
  for (auto& node : nodes) node["name"] = "";
  nodes[0].erase("children");
  avatar.add_mesh(avatar.square());
  const std::string error = error_of(avatar.glb());
  EXPECT_NE(error.find("leftUpperArm"), error.npos) << error;
  EXPECT_NE(error.find("rightFoot"), error.npos) << error;
  EXPECT_EQ(error.find("hips,"), error.npos) << error;
}

TEST(AvatarBones, VrmTellsTheBonesWhateverTheNodesAreCalled) {
  TinyAvatar avatar;
  auto& bones = avatar.json["extensions"]["VRMC_vrm"]["humanoid"]["humanBones"];
  for (const BoneInfo& bone : kBones)
    if (bone.name != "upperChest")
      bones[std::string(bone.name)]["node"] = avatar.node(std::string(bone.name));
  for (auto& node : avatar.json["nodes"]) node["name"] = "x";
  avatar.add_mesh(avatar.square());
  const AvatarModel model = test::model_of(avatar);
  ASSERT_FALSE(model.nodes.empty());
  EXPECT_GE(model.node_of(Bone::kLeftToes), 0);
  EXPECT_EQ(model.node_of(Bone::kUpperChest), -1);
}

TEST(AvatarBones, ABoneThatHangsFromTheWrongOneIsAnErrorOrLeftOut) {
  TinyAvatar avatar;
  auto& bones = avatar.json["extensions"]["VRMC_vrm"]["humanoid"]["humanBones"];
  for (const BoneInfo& bone : kBones)
    if (bone.name != "upperChest")
      bones[std::string(bone.name)]["node"] = avatar.node(std::string(bone.name));
  avatar.add_mesh(avatar.square());
  const auto toes = bones["leftToes"];
  bones["leftToes"] = bones["rightToes"];
  bones.erase("rightToes");
  const auto read = read_avatar(avatar.glb());
  ASSERT_TRUE(read) << read.error().what;
  EXPECT_EQ(read->model.node_of(Bone::kLeftToes), -1);
  EXPECT_EQ(read->notes.size(), 1u);
  std::swap(bones["leftHand"], bones["leftUpperArm"]);
  EXPECT_NE(error_of(avatar.glb()).find("does not hang"), std::string::npos);
}

struct Turned {
  const char* what;
  std::array<float, 4> rotation;  // of a node above all
};

TEST(AvatarBones, TheFigureIsTurnedToFaceForwardWithItsHeadUp) {
  constexpr float kHalf = 0.70710678f;
  const Turned cases[] = {{"forward", {0, 0, 0, 1}},          {"back", {0, 1, 0, 0}},
                          {"left", {0, kHalf, 0, kHalf}},     {"right", {0, -kHalf, 0, kHalf}},
                          {"face up", {-kHalf, 0, 0, kHalf}}, {"on its side", {0, 0, kHalf, kHalf}},
                          {"on its head", {1, 0, 0, 0}}};
  for (const Turned& turned : cases) {
    SCOPED_TRACE(turned.what);
    TinyAvatar avatar;
    avatar.add_mesh(avatar.square());
    const int root = avatar.add_node("Armature", -1, {0, 0, 0});
    avatar.json["nodes"][static_cast<std::size_t>(root)]["rotation"] = turned.rotation;
    avatar.json["nodes"][static_cast<std::size_t>(root)]["children"] = {avatar.node("hips")};
    const AvatarModel model = test::model_of(avatar);
    ASSERT_FALSE(model.nodes.empty());
    const auto rest = rest_transforms(model);
    const auto place = [&](Bone bone) {
      return rest[static_cast<std::size_t>(model.node_of(bone))].translation();
    };
    EXPECT_NEAR((place(Bone::kLeftHand) - Eigen::Vector3d(0.7, 1.42, 0.0)).norm(), 0.0, 1e-5);
    EXPECT_NEAR((place(Bone::kRightToes) - Eigen::Vector3d(-0.1, 0.02, 0.12)).norm(), 0.0, 1e-5);
  }
}

TEST(AvatarBones, AFigureThatFacesBackIsTurnedByAHalfTurnAndNothingElse) {
  TinyAvatar avatar({}, true);
  avatar.add_mesh(avatar.square());
  const auto read = read_avatar(avatar.glb());
  ASSERT_TRUE(read) << read.error().what;
  EXPECT_TRUE(read->notes.empty());
  const AvatarNode& hips =
      read->model.nodes[static_cast<std::size_t>(read->model.node_of(Bone::kHips))];
  EXPECT_NEAR(std::abs(hips.rotation.y()), 1.0f, 1e-6f);
  EXPECT_NEAR((hips.translation_m - Eigen::Vector3f(0, 1, 0)).norm(), 0.0f, 1e-6f);
}

}  // namespace
}  // namespace dance
