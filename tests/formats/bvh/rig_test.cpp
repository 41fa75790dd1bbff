#include "formats/bvh/rig/rig.h"

#include <gtest/gtest.h>

#include <map>
#include <string>

#include "tests/formats/bvh/bvh_sample.h"

namespace dance {
namespace {

using Names = std::map<std::string, std::string>;

Result<Rig> rig_of(const std::string& text) {
  const auto bvh = read_bvh(text);
  if (!bvh) return tl::make_unexpected(bvh.error());
  return find_rig(*bvh);
}

// The bones of a sample by the names that its joints have.
Names names_in(const std::string& name) {
  const auto bvh = read_bvh(test::sample(name));
  if (!bvh) return {{"error", bvh.error().what}};
  const auto rig = find_rig(*bvh);
  if (!rig) return {{"error", rig.error().what}};
  Names names;
  for (std::size_t b = 0; b < kBoneCount; ++b)
    if (rig->joint_of[b] != kNoJoint)
      names[std::string(kBones[b].name)] =
          bvh->joints[static_cast<std::size_t>(rig->joint_of[b])].name;
  for (std::size_t f = 0; f < kFingerBoneCount; ++f)
    if (rig->finger_of[f] != kNoJoint)
      names[std::string(kFingerBones[f].name)] =
          bvh->joints[static_cast<std::size_t>(rig->finger_of[f])].name;
  return names;
}

void expect_names(const std::string& sample, const Names& expected) {
  Names names = names_in(sample);
  for (const auto& [bone, joint] : expected)
    EXPECT_EQ(names[bone], joint) << sample << ": " << bone;
}

TEST(Rig, KnowsMixamoWithItsPrefixAndFingers) {
  const std::string p = "mixamorig:";
  expect_names("mixamo", {{"hips", p + "Hips"},
                          {"upperChest", p + "Spine2"},
                          {"neck", p + "Neck"},
                          {"leftShoulder", p + "LeftShoulder"},
                          {"leftUpperArm", p + "LeftArm"},
                          {"leftLowerArm", p + "LeftForeArm"},
                          {"rightUpperLeg", p + "RightUpLeg"},
                          {"rightLowerLeg", p + "RightLeg"},
                          {"rightToes", p + "RightToeBase"},
                          {"leftThumbMetacarpal", p + "LeftHandThumb1"},
                          {"leftThumbDistal", p + "LeftHandThumb3"},
                          {"rightLittleDistal", p + "RightHandPinky3"},
                          {"leftRingProximal", ""}});
}

TEST(Rig, KnowsMixamoWithoutItsPrefix) {
  const auto rig = rig_of(test::replaced(test::sample("mixamo"), "mixamorig:", ""));
  ASSERT_TRUE(rig.has_value()) << rig.error().what;
  EXPECT_TRUE(rig->is_from_names);
  EXPECT_TRUE(rig->has(Bone::kLeftToes));
}

TEST(Rig, KnowsDazWithItsButtocks) {
  expect_names("daz", {{"hips", "hip"},
                       {"spine", "abdomen"},
                       {"chest", "chest"},
                       {"upperChest", ""},
                       {"leftShoulder", "lCollar"},
                       {"leftUpperArm", "lShldr"},
                       {"leftLowerArm", "lForeArm"},
                       {"rightUpperLeg", "rThigh"},
                       {"rightToes", ""}});
}

TEST(Rig, KnowsCmuInSmallLetters) {
  expect_names("asf", {{"hips", "root"},
                       {"spine", "lowerback"},
                       {"chest", "upperback"},
                       {"upperChest", "thorax"},
                       {"neck", "lowerneck"},
                       {"leftShoulder", "lclavicle"},
                       {"leftUpperArm", "lhumerus"},
                       {"leftLowerArm", "lradius"},
                       {"leftHand", "lwrist"},
                       {"rightUpperLeg", "rfemur"},
                       {"rightLowerLeg", "rtibia"},
                       {"rightToes", "rtoes"}});
}

TEST(Rig, KnowsCmuInMotionBuildersNames) {
  expect_names("cgspeed", {{"spine", "LowerBack"},
                           {"upperChest", "Spine2"},
                           {"leftUpperLeg", "LeftUpLeg"},
                           {"leftUpperArm", "LeftArm"},
                           {"leftHand", "LeftHand"}});
}

// The same words as Mixamo's for other bones: LeftShoulder is an upper arm, LeftHip a thigh.
TEST(Rig, TellsShouldersAndHipsByWhatElseIsThere) {
  expect_names("motionbuilder_hips", {{"leftShoulder", "LeftCollar"},
                                      {"leftUpperArm", "LeftShoulder"},
                                      {"leftLowerArm", "LeftElbow"},
                                      {"leftUpperLeg", "LeftHip"},
                                      {"leftLowerLeg", "LeftKnee"},
                                      {"leftFoot", "LeftAnkle"},
                                      {"leftToes", "LeftToe"}});
}

TEST(Rig, KnowsBipedWithBlanksOrUnderscores) {
  expect_names("biped", {{"hips", "Bip01 Pelvis"},
                         {"leftShoulder", "Bip01 L Clavicle"},
                         {"leftLowerLeg", "Bip01 L Calf"},
                         {"leftMiddleProximal", "Bip01 L Finger2"},
                         {"rightToes", "Bip01 R Toe0"}});
  expect_names("biped_neck", {{"spine", "Bip01_Spine"},
                              {"chest", "Bip01_Spine1"},
                              {"neck", "Bip01_Neck"},
                              {"leftThumbMetacarpal", "Bip01_L_Finger0"},
                              {"leftThumbProximal", "Bip01_L_Finger01"},
                              {"rightIndexIntermediate", "Bip01_R_Finger11"}});
}

TEST(Rig, KnowsBlenderWhoseSpineIsNumbered) {
  expect_names("blender", {{"hips", "spine"},
                           {"spine", "spine.001"},
                           {"upperChest", "spine.003"},
                           {"neck", "spine.004"},
                           {"head", "spine.006"},
                           {"leftUpperArm", "upper_arm.L"},
                           {"rightLowerLeg", "shin.R"}});
}

TEST(Rig, KnowsXsensSmplUnrealAndVrm) {
  expect_names("xsens", {{"spine", "Chest"}, {"chest", "Chest3"}, {"upperChest", "Chest4"}});
  expect_names("smpl", {{"leftFoot", "L_Ankle"},
                        {"leftToes", "L_Foot"},
                        {"leftHand", "L_Wrist"},
                        {"leftShoulder", "L_Collar"}});
  expect_names("unreal", {{"leftLowerArm", "lowerarm_l"},
                          {"rightUpperLeg", "thigh_r"},
                          {"rightLowerLeg", "calf_r"},
                          {"rightToes", "ball_r"}});
  const Names vrm = names_in("vrm");
  EXPECT_EQ(vrm.size(), kBoneCount);
  for (const auto& [bone, joint] : vrm) EXPECT_EQ(bone, joint);
}

TEST(Rig, IsFoundByShapeWhereNamesSayNothing) {
  const auto nameless = rig_of(test::sample("nameless"));
  ASSERT_TRUE(nameless.has_value()) << nameless.error().what;
  EXPECT_FALSE(nameless->is_from_names);
  expect_names("nameless", {{"hips", "joint01"},
                            {"upperChest", "joint04"},
                            {"neck", "joint05"},
                            {"head", "joint06"},
                            {"leftUpperLeg", "joint21"},
                            {"leftFoot", "joint23"},
                            {"rightUpperLeg", "joint25"}});
}

TEST(Rig, NamesTheBonesThatItCannotFind) {
  const auto rig = rig_of(test::kTwoJoints);
  ASSERT_FALSE(rig.has_value());
  EXPECT_NE(rig.error().what.find("no human figure: no joint found for hips, leftUpperArm"),
            std::string::npos)
      << rig.error().what;
  EXPECT_NE(rig.error().what.find("among 2 joints ('hips', 'spine')"), std::string::npos);
}

TEST(Rig, FallsBackOnTheShapeWhereOneLegHasNoName) {
  std::string text = test::sample("vrm");
  for (const char* name : {"rightUpperLeg", "rightLowerLeg", "rightFoot", "rightToes"})
    text = test::replaced(text, name, "tail");
  const auto rig = rig_of(text);
  ASSERT_TRUE(rig.has_value()) << rig.error().what;
  EXPECT_FALSE(rig->is_from_names);
}

}  // namespace
}  // namespace dance
