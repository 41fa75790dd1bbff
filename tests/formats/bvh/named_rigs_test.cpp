// Figures as exporters of others name and build them.
#include <gtest/gtest.h>

#include <numbers>

#include "core/pose/kinematics.h"
#include "formats/bvh/retarget.h"
#include "tests/formats/bvh/built_figure.h"
#include "tests/formats/bvh/bvh_sample.h"

namespace dance {
namespace {

using Eigen::Vector3d;
using test::built_human;
using test::BuiltFigure;
using test::mixamo_fingers;
using test::RigWords;

constexpr float kOneMillimetre_m = 1e-3f;

Result<Retargeted> read_built(const std::string& text) {
  const auto bvh = read_bvh(text);
  if (!bvh) return tl::make_unexpected(bvh.error());
  return retarget(*bvh);
}

std::string joint_named(const Bvh& bvh, int joint) {
  return joint == kNoJoint ? "" : bvh.joints[static_cast<std::size_t>(joint)].name;
}

std::string all_notes(const Retargeted& result) {
  std::string all;
  for (const std::string& note : result.notes) all += note + "\n";
  return all;
}

// Bends elbow, knee and neck, each differently.
void bend(BuiltFigure& figure, const RigWords& words) {
  figure.turn(test::with_side(words, words.lower_arm, true), {0, 0, -40});
  figure.turn(test::with_side(words, words.lower_arm, false), {0, 0, 55});
  figure.turn(test::with_side(words, words.upper_arm, true), {-30, 0, 0});
  figure.turn(test::with_side(words, words.shin, true), {0, 35, 0});
  figure.turn(test::with_side(words, words.thigh, false), {0, -50, 0});
  figure.turn(test::with_side(words, words.foot, false), {0, 15, 0});
  figure.turn(words.neck, {10, 0, 20});
}

// Truth is the same figure in Mixamo's words.
void expect_as_mixamo(const std::string& text, const char* what, bool has_fingers = false) {
  SCOPED_TRACE(what);
  RigWords words;
  if (has_fingers) words.fingers = mixamo_fingers();
  BuiltFigure mixamo = built_human(words);
  bend(mixamo, words);
  const auto truth = read_built(mixamo.bvh());
  const auto result = read_built(text);
  ASSERT_TRUE(truth.has_value()) << truth.error().what;
  ASSERT_TRUE(result.has_value()) << result.error().what;
  BodyFrames expected;
  BodyFrames body;
  forward_kinematics(truth->clip.skeleton, truth->clip.frames[1], expected);
  forward_kinematics(result->clip.skeleton, result->clip.frames[1], body);
  for (const Bone bone :
       {Bone::kHips, Bone::kNeck, Bone::kHead, Bone::kLeftShoulder, Bone::kLeftUpperArm,
        Bone::kLeftLowerArm, Bone::kLeftHand, Bone::kRightUpperArm, Bone::kRightLowerArm,
        Bone::kRightHand, Bone::kLeftUpperLeg, Bone::kLeftLowerLeg, Bone::kLeftFoot,
        Bone::kLeftToes, Bone::kRightUpperLeg, Bone::kRightLowerLeg, Bone::kRightFoot}) {
    EXPECT_LT((body.position(bone) - expected.position(bone)).norm(), kOneMillimetre_m)
        << kBones[index_of(bone)].name;
    EXPECT_LT(body.R_WB[index_of(bone)].angularDistance(expected.R_WB[index_of(bone)]), 0.01f)
        << kBones[index_of(bone)].name;
  }
}

struct ToolWords {
  const char* tool;
  RigWords words;
};

std::vector<std::string> fingers_of(const std::vector<std::string>& begins,
                                    const std::vector<std::string>& ends) {
  std::vector<std::string> names;
  for (const std::string& begin : begins)
    for (const std::string& end : ends) names.push_back(begin + end);
  return names;
}

std::vector<ToolWords> words_of_tools() {
  return {
      {"Motive",
       {"Hip", "Ab", "Chest", "Neck", "Head", "<Shoulder", "<UArm", "<FArm", "<Hand", "<Thigh",
        "<Shin", "<Foot", "<Toe", "L", "R",
        fingers_of({"<Thumb", "<Index", "<Middle", "<Ring", "<Pinky"}, {"1", "2", "3"})}},
      {"MMD",
       {"センター", "上半身", "上半身2", "首", "頭", "<肩", "<腕", "<ひじ", "<手首", "<足", "<ひざ",
        "<足首", "<つま先", "左", "右",
        fingers_of({"<親指", "<人指", "<中指", "<薬指", "<小指"}, {"１", "２", "３"})}},
      {"MMD in Blender",
       {"center",
        "upper body",
        "upper body2",
        "neck",
        "head",
        "shoulder_<",
        "arm_<",
        "elbow_<",
        "wrist_<",
        "leg_<",
        "knee_<",
        "ankle_<",
        "toe_<",
        "L",
        "R",
        {}}},
      {"MakeHuman",
       {"root",
        "spine03",
        "spine01",
        "neck01",
        "head",
        "clavicle.<",
        "upperarm01.<",
        "lowerarm01.<",
        "wrist.<",
        "upperleg01.<",
        "lowerleg01.<",
        "foot.<",
        "toe1-1.<",
        "L",
        "R",
        {"finger1-1.<", "finger1-2.<", "finger1-3.<", "finger2-1.<", "finger2-2.<", "finger2-3.<",
         "finger3-1.<", "finger3-2.<", "finger3-3.<", "finger4-1.<", "finger4-2.<", "finger4-3.<",
         "finger5-1.<", "finger5-2.<", "finger5-3.<"}}},
      {"Source",
       {"ValveBiped.Bip01_Pelvis", "ValveBiped.Bip01_Spine", "ValveBiped.Bip01_Spine2",
        "ValveBiped.Bip01_Neck1", "ValveBiped.Bip01_Head1", "ValveBiped.Bip01_<_Clavicle",
        "ValveBiped.Bip01_<_UpperArm", "ValveBiped.Bip01_<_Forearm", "ValveBiped.Bip01_<_Hand",
        "ValveBiped.Bip01_<_Thigh", "ValveBiped.Bip01_<_Calf", "ValveBiped.Bip01_<_Foot",
        "ValveBiped.Bip01_<_Toe0", "L", "R",
        fingers_of({"ValveBiped.Bip01_<_Finger0", "ValveBiped.Bip01_<_Finger1",
                    "ValveBiped.Bip01_<_Finger2", "ValveBiped.Bip01_<_Finger3",
                    "ValveBiped.Bip01_<_Finger4"},
                   {"", "1", "2"})}},
      {"Source 2",
       {"pelvis",
        "spine_0",
        "spine_2",
        "neck_0",
        "head",
        "clavicle_<",
        "arm_upper_<",
        "arm_lower_<",
        "hand_<",
        "leg_upper_<",
        "leg_lower_<",
        "ankle_<",
        "ball_<",
        "L",
        "R",
        {}}},
      {"Team Fortress",
       {"bip_pelvis",
        "bip_spine_0",
        "bip_spine_1",
        "bip_neck",
        "bip_head",
        "bip_collar_<",
        "bip_upperArm_<",
        "bip_lowerArm_<",
        "bip_hand_<",
        "bip_hip_<",
        "bip_knee_<",
        "bip_foot_<",
        "bip_toe_<",
        "L",
        "R",
        {}}},
  };
}

TEST(NamedRigs, AreReadWithTheNamesOfManyTools) {
  for (const auto& [tool, words] : words_of_tools()) {
    BuiltFigure figure = built_human(words);
    bend(figure, words);
    const auto result = read_built(figure.bvh());
    ASSERT_TRUE(result.has_value()) << tool << ": " << result.error().what;
    EXPECT_TRUE(result->rig.is_from_names) << tool;
    expect_as_mixamo(figure.bvh(), tool, !words.fingers.empty());
    if (words.fingers.empty()) continue;
    const auto bvh = read_bvh(figure.bvh());
    for (std::size_t f = 0; f < kFingerBoneCount; ++f)
      EXPECT_EQ(joint_named(*bvh, result->rig.finger_of[f]),
                test::with_side(words, words.fingers[f % 15], f < 15))
          << tool << ": " << kFingerBones[f].name;
  }
}

TEST(NamedRigs, AreFoundByShapeWithScrambledNames) {
  for (const bool has_fingers : {false, true}) {
    RigWords words;
    if (has_fingers) words.fingers = mixamo_fingers();
    BuiltFigure figure = built_human(words);
    bend(figure, words);
    const auto by_names = read_bvh(figure.bvh());
    const auto truth = find_rig(*by_names);
    figure.scramble_names();
    const auto bvh = read_bvh(figure.bvh());
    const auto rig = find_rig(*bvh);
    ASSERT_TRUE(rig.has_value()) << rig.error().what;
    EXPECT_FALSE(rig->is_from_names);
    EXPECT_EQ(rig->joint_of, truth->joint_of);
    EXPECT_EQ(rig->finger_of, truth->finger_of);
    expect_as_mixamo(figure.bvh(), "scrambled", has_fingers);
  }
}

// Every sample in tests/formats/bvh/data: the limbs that names give are those that the shape gives.
TEST(NamedRigs, OfEverySampleAreFoundByShapeToo) {
  constexpr Bone kLimbBones[] = {Bone::kHips,          Bone::kLeftUpperArm,  Bone::kLeftLowerArm,
                                 Bone::kRightUpperArm, Bone::kRightLowerArm, Bone::kLeftUpperLeg,
                                 Bone::kLeftLowerLeg,  Bone::kRightUpperLeg, Bone::kRightLowerLeg,
                                 Bone::kLeftFoot,      Bone::kRightFoot};
  for (const char* sample : {"asf", "biped", "biped_neck", "blender", "cgspeed", "daz", "mixamo",
                             "motionbuilder_hips", "smpl", "unreal", "vrm", "xsens"}) {
    auto bvh = read_bvh(test::sample(sample));
    ASSERT_TRUE(bvh.has_value()) << sample;
    const auto truth = find_rig(*bvh);
    for (std::size_t j = 0; j < bvh->joints.size(); ++j)
      bvh->joints[j].name = "q" + std::to_string(j * 7919 % 1009);
    const auto rig = find_rig(*bvh);
    ASSERT_TRUE(rig.has_value()) << sample << ": " << rig.error().what;
    EXPECT_FALSE(rig->is_from_names) << sample;
    for (const Bone bone : kLimbBones)
      EXPECT_EQ(rig->joint(bone), truth->joint(bone))
          << sample << ": " << kBones[index_of(bone)].name;
  }
}

TEST(NamedRigs, UseTheBoneAndNotAHelperWithTheSameName) {
  RigWords words;
  words.lower_arm = "Lo<Arm";
  words.shin = "LoLeg_<";
  words.thigh = "UpLeg_<";
  words.left = "L";
  words.right = "R";
  words.collar = "Clavicle_<";
  words.upper_arm = "UpArm_<";
  words.lower_arm = "LoArm_<";
  words.hand = "Hand_<";
  words.foot = "Foot_<";
  words.toes = "Toe_<";
  for (const double share : {0.0, 0.7, 1.0}) {
    BuiltFigure figure = built_human(words);
    bend(figure, words);
    for (const char* side : {"L", "R"}) {
      figure.put_above("UpLeg_" + std::string(side), "__UpLeg_" + std::string(side), share);
      figure.put_above("Clavicle_" + std::string(side), "__Clavicle_" + std::string(side), share);
    }
    expect_as_mixamo(figure.bvh(), "helpers");
    const auto result = read_built(figure.bvh());
    EXPECT_NE(all_notes(*result).find("several joints are named as one bone: leftShoulder is "
                                      "'Clavicle_L', not '__Clavicle_L'"),
              std::string::npos)
        << all_notes(*result);
  }
}

// Two joints in the middle named as thighs, the real ones below with names that mean nothing.
TEST(NamedRigs, UseTheShapeIfNamesGiveNoHumanFigure) {
  BuiltFigure figure = built_human({});
  bend(figure, {});
  for (const char* side : {"Left", "Right"}) {
    const std::string leg = side;
    figure.put_above(leg + "UpLeg", leg + "Pelvis", 0.0);
    figure.at(leg + "Leg").name = leg + "Xyz";
    figure.turn(leg + "Xyz", leg == "Left" ? Vector3d(0, 35, 0) : Vector3d(0, 0, 0));
    figure.turn(leg + "Abc", leg == "Left" ? Vector3d(0, 0, 0) : Vector3d(0, -50, 0));
    figure.at(leg + "UpLeg").name = leg + "Abc";
    figure.at(leg + "Pelvis").name = leg + "UpLeg";
    figure.turn(leg + "UpLeg", {0, 0, 0});
  }
  expect_as_mixamo(figure.bvh(), "misnamed thighs");
  const auto result = read_built(figure.bvh());
  ASSERT_TRUE(result.has_value());
  EXPECT_FALSE(result->rig.is_from_names);
  EXPECT_NE(all_notes(*result).find("joint names give no human figure, as "), std::string::npos)
      << all_notes(*result);
}

TEST(NamedRigs, AreReadBelowTheRootOfOtherSoftware) {
  RigWords words;
  for (std::string* word : {&words.hips, &words.spine, &words.chest, &words.neck, &words.head,
                            &words.collar, &words.upper_arm, &words.lower_arm, &words.hand,
                            &words.thigh, &words.shin, &words.foot, &words.toes})
    *word = "hero_" + *word;
  BuiltFigure figure = built_human(words);
  bend(figure, words);
  const auto below = [&](const std::string& text) {
    const std::size_t root = text.find("ROOT");
    const std::size_t motion = text.find("MOTION");
    std::string out = text.substr(0, root) +
                      "ROOT Scene\n{\nOFFSET 0 0 0\nCHANNELS 0\nJOINT Camera\n{\nOFFSET 0 300 900\n"
                      "CHANNELS 0\nEnd Site\n{\nOFFSET 0 0 10\n}\n}\nJOINT" +
                      text.substr(root + 4, motion - root - 4) + "}\n" + text.substr(motion);
    return out;
  };
  const auto result = read_built(below(figure.bvh()));
  ASSERT_TRUE(result.has_value()) << result.error().what;
  EXPECT_TRUE(result->rig.is_from_names);
  expect_as_mixamo(below(figure.bvh()), "foreign root");
}

TEST(NamedRigs, NumberFingersFromWhatIsThere) {
  RigWords words;
  words.fingers = {"<Finger1Metacarpal", "<Finger1Proximal", "<Finger1Distal"};
  for (const char* number : {"2", "3", "4", "5"})
    for (const char* part : {"Proximal", "Medial", "Distal"})
      words.fingers.push_back(std::string("<Finger") + number + part);
  BuiltFigure figure = built_human(words);
  const auto bvh = read_bvh(figure.bvh());
  const auto rig = find_rig(*bvh);
  ASSERT_TRUE(rig.has_value()) << rig.error().what;
  for (std::size_t f = 0; f < kFingerBoneCount; ++f)
    EXPECT_EQ(joint_named(*bvh, rig->finger_of[f]),
              test::with_side(words, words.fingers[f % 15], f < 15))
        << kFingerBones[f].name;
}

TEST(NamedRigs, LeaveOutTheJointsOfThePalm) {
  RigWords words;
  words.fingers = mixamo_fingers();
  BuiltFigure figure = built_human(words);
  for (const std::string side : {"Left", "Right"})
    for (const char* finger : {"Index", "Ring", "Pinky"})
      figure.put_above(side + "Hand" + finger + "1", side + "Hand" + finger, 0.3);
  for (const char* number : {"1", "2", "3"})
    figure.turn(std::string("LeftHandIndex") + number, {-50, 0, 0});
  for (const bool is_named : {true, false}) {
    if (!is_named) figure.scramble_names();
    const auto result = read_built(figure.bvh());
    ASSERT_TRUE(result.has_value()) << result.error().what;
    ASSERT_EQ(result->clip.hands.size(), 2u);
    for (const std::size_t bone : {3u, 4u, 5u})
      EXPECT_NEAR(
          result->clip.hands[1].R_PB[bone].angularDistance(result->clip.hands[0].R_PB[bone]),
          50.0f * std::numbers::pi_v<float> / 180.0f, 0.01f)
          << kFingerBones[bone].name;
  }
}

TEST(NamedRigs, MeasureAFootToTheFarEndOfItsChain) {
  for (const char* toes : {"<ForeFoot", "<Toe"}) {
    RigWords words;
    words.toes = toes;
    BuiltFigure figure = built_human(words);
    for (const bool left : {true, false}) {
      test::BuiltJoint& joint = figure.at(test::with_side(words, toes, left));
      joint.offset_cm = Vector3d(0, -4, 0);
      joint.end_cm = Vector3d(0, 0, 21);
    }
    const auto result = read_built(figure.bvh());
    ASSERT_TRUE(result.has_value()) << result.error().what;
    const BodyFrames body = [&] {
      BodyFrames frames;
      forward_kinematics(result->clip.skeleton, result->clip.frames[1], frames);
      return frames;
    }();
    const Eigen::Vector3f foot = body.tip(Tip::kLeftToes) - body.position(Bone::kLeftFoot);
    EXPECT_LT((foot - Eigen::Vector3f(0, -0.04f, 0.21f)).norm(), kOneMillimetre_m)
        << toes << ": " << foot.transpose();
    EXPECT_LT(body.R_WB[index_of(Bone::kLeftFoot)].angularDistance(Eigen::Quaternionf::Identity()),
              0.01f);
  }
}

TEST(NamedRigs, KeepHandsStraightWhoseEndSitesPointDown) {
  BuiltFigure figure = built_human({});
  for (const char* hand : {"LeftHand", "RightHand"}) figure.at(hand).end_cm = Vector3d(0, -8, 0);
  const auto result = read_built(figure.bvh());
  ASSERT_TRUE(result.has_value()) << result.error().what;
  BodyFrames body;
  forward_kinematics(result->clip.skeleton, result->clip.frames[0], body);
  for (const Bone hand : {Bone::kLeftHand, Bone::kRightHand})
    EXPECT_LT(body.R_WB[index_of(hand)].angularDistance(Eigen::Quaternionf::Identity()), 0.01f);
  EXPECT_NEAR(body.tip(Tip::kLeftHand).y(), body.position(Bone::kLeftHand).y(), kOneMillimetre_m);
  EXPECT_GT(body.tip(Tip::kLeftHand).x(), body.position(Bone::kLeftHand).x() + 0.1f);
}

}  // namespace
}  // namespace dance
