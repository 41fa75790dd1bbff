#include "formats/bvh/retarget.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "core/pose/kinematics.h"
#include "tests/formats/bvh/bvh_sample.h"

namespace dance {
namespace {

using Eigen::Vector3f;

// All samples of tests/formats/bvh/data hold one motion, in the words, units, axes and rest poses
// of many tools: standing, a step forward turned to the left, and a turn to the right.
constexpr const char* kStyles[] = {
    "asf",      "biped", "biped_neck", "blender", "cgspeed", "daz", "mixamo", "motionbuilder_hips",
    "nameless", "smpl",  "unreal",     "vrm",     "xsens"};
constexpr float kMillimetre_m = 1e-3f;

Result<Retargeted> retargeted(const std::string& text, const RetargetOptions& options = {}) {
  const auto bvh = read_bvh(text);
  if (!bvh) return tl::make_unexpected(bvh.error());
  return retarget(*bvh, options);
}

RetargetOptions heights_kept() {
  RetargetOptions options;
  options.puts_feet_on_floor = false;
  return options;
}

std::string notes_of(const Retargeted& result) {
  std::string all;
  for (const std::string& note : result.notes) all += note + "\n";
  return all;
}

BodyFrames body_at(const MotionClip& clip, std::size_t frame) {
  BodyFrames body;
  forward_kinematics(clip.skeleton, clip.frames[frame], body);
  return body;
}

struct Place {
  std::size_t frame;
  Bone bone;
  Vector3f p_W_m;
};
// Reckoned apart from this code, when the samples were made.
const Place kTruth[] = {
    {1, Bone::kLeftUpperArm, {0.4833f, 1.3511f, 0.1328f}},
    {1, Bone::kLeftLowerArm, {0.6248f, 1.1282f, 0.0397f}},
    {1, Bone::kLeftHand, {0.7120f, 0.9955f, 0.2328f}},
    {1, Bone::kRightHand, {0.3304f, 1.2218f, 0.6453f}},
    {1, Bone::kLeftLowerLeg, {0.5722f, 0.5578f, 0.2774f}},
    {1, Bone::kLeftFoot, {0.5722f, 0.1685f, 0.1859f}},
    {1, Bone::kRightFoot, {0.1443f, 0.1006f, 0.0421f}},
    {2, Bone::kRightUpperArm, {-0.3106f, 1.3537f, 0.2717f}},
    {2, Bone::kLeftHand, {-0.6849f, 1.4453f, 0.6480f}},
    {2, Bone::kRightHand, {-0.3095f, 0.8661f, 0.1153f}},
    {2, Bone::kRightLowerLeg, {-0.5353f, 0.6759f, 0.3004f}},
    {2, Bone::kRightFoot, {-0.4244f, 0.3216f, 0.4492f}},
};

TEST(Retarget, PutsTheJointsOfEveryToolWhereTheyAre) {
  for (const std::string style : kStyles) {
    SCOPED_TRACE(style);
    const auto result = retargeted(test::sample(style), heights_kept());
    ASSERT_TRUE(result.has_value()) << result.error().what;
    ASSERT_EQ(result->clip.frames.size(), 3u);
    EXPECT_TRUE(is_valid(result->clip.skeleton));
    // cgspeed has a joint more in the spine than we have bones.
    const float within_m = style == "cgspeed" ? 2.0f * kMillimetre_m : 0.3f * kMillimetre_m;
    for (const Place& truth : kTruth) {
      const BodyFrames body = body_at(result->clip, truth.frame);
      EXPECT_LT((body.position(truth.bone) - truth.p_W_m).norm(), within_m)
          << kBones[index_of(truth.bone)].name << " in frame " << truth.frame << " is at "
          << body.position(truth.bone).transpose();
    }
  }
}

// A rest pose with arms down or legs apart must not come through as a twist of the bones.
TEST(Retarget, GivesLimbsTheSameRotationsFromEveryTool) {
  const auto truth = retargeted(test::sample("vrm"));
  ASSERT_TRUE(truth.has_value()) << truth.error().what;
  for (const std::string style : kStyles) {
    const auto result = retargeted(test::sample(style));
    ASSERT_TRUE(result.has_value()) << style << ": " << result.error().what;
    for (const std::size_t frame : {1u, 2u})
      for (const Bone bone :
           {Bone::kHips, Bone::kLeftUpperArm, Bone::kRightUpperArm, Bone::kLeftLowerArm,
            Bone::kRightLowerArm, Bone::kLeftUpperLeg, Bone::kRightUpperLeg, Bone::kLeftLowerLeg,
            Bone::kRightLowerLeg, Bone::kLeftFoot, Bone::kRightFoot}) {
        const auto R_WB = [&](const Retargeted& r) {
          return body_at(r.clip, frame).R_WB[index_of(bone)];
        };
        EXPECT_LT(R_WB(*result).angularDistance(R_WB(*truth)), 0.01f)
            << style << ": " << kBones[index_of(bone)].name << " in frame " << frame;
      }
  }
}

TEST(Retarget, BendsKneesBackwardsAndElbowsForwards) {
  for (const std::string style : kStyles) {
    const auto result = retargeted(test::sample(style));
    ASSERT_TRUE(result.has_value()) << style << ": " << result.error().what;
    const Pose& step = result->clip.frames[1];
    const auto bone_in_parent = [&](Bone bone, const Vector3f& rest) {
      return Vector3f(step.R_PB[index_of(bone)] * rest);
    };
    EXPECT_LT(bone_in_parent(Bone::kLeftLowerLeg, -Vector3f::UnitY()).z(), -0.5f) << style;
    EXPECT_GT(bone_in_parent(Bone::kLeftLowerArm, Vector3f::UnitX()).z(), 0.5f) << style;
    EXPECT_GT(bone_in_parent(Bone::kRightLowerArm, -Vector3f::UnitX()).z(), 0.5f) << style;
  }
}

TEST(Retarget, SaysWhichUnitItGuessed) {
  const std::pair<const char*, const char*> kUnits[] = {
      {"vrm", "units are metres: the figure is 1.72 m tall"},
      {"mixamo", "units are centimetres: the figure is 1.72 m tall"},
      {"unreal", "units are millimetres"},
      {"biped", "units are inches"},
      {"asf", "units are CMU's units of 0.0564444 m"}};
  for (const auto& [style, note] : kUnits) {
    const auto result = retargeted(test::sample(style));
    ASSERT_TRUE(result.has_value()) << result.error().what;
    EXPECT_NE(notes_of(*result).find(note), std::string::npos) << notes_of(*result);
  }
}

TEST(Retarget, TakesTheUnitThatIsGiven) {
  RetargetOptions options = heights_kept();
  options.metres_per_unit = 0.005;
  const auto half = retargeted(test::sample("mixamo"), options);
  ASSERT_TRUE(half.has_value()) << half.error().what;
  EXPECT_EQ(notes_of(*half).find("units are"), std::string::npos);
  EXPECT_NEAR(standing_height_m(half->clip.skeleton), 0.86f, 0.02f);
  const Vector3f hand = body_at(half->clip, 1).position(Bone::kLeftHand);
  EXPECT_LT((hand - 0.5f * kTruth[2].p_W_m).norm(), kMillimetre_m);
}

TEST(Retarget, RefusesAUnitThatMakesGiants) {
  RetargetOptions options;
  options.metres_per_unit = 1.0;
  const auto giant = retargeted(test::sample("mixamo"), options);
  ASSERT_FALSE(giant.has_value());
  EXPECT_EQ(giant.error().what,
            "bones longer than 2 m: give the right unit to dance convert, as --unit cm; this one "
            "makes the figure 172 m tall");
  options.metres_per_unit = -1.0;
  EXPECT_FALSE(retargeted(test::sample("mixamo"), options).has_value());
}

TEST(Retarget, SaysThatItTurnedZUp) {
  const auto result = retargeted(test::sample("blender"));
  ASSERT_TRUE(result.has_value()) << result.error().what;
  EXPECT_NE(notes_of(*result).find("up is +Z in this file: turned to +Y"), std::string::npos);
  EXPECT_NE(notes_of(*result).find("the rest pose faces -Y, up +Z"), std::string::npos);
}

TEST(Retarget, SaysThatItTookAFrameForTheRestPose) {
  const auto result = retargeted(test::sample("biped"));
  ASSERT_TRUE(result.has_value()) << result.error().what;
  EXPECT_NE(notes_of(*result).find("without rotations the figure does not stand: frame 1 taken"),
            std::string::npos);
}

TEST(Retarget, StandsADancerOnTheFloor) {
  const auto result = retargeted(test::sample("vrm"));
  ASSERT_TRUE(result.has_value()) << result.error().what;
  float lowest = 10.0f;
  for (std::size_t f = 0; f < 3; ++f) {
    const BodyFrames body = body_at(result->clip, f);
    for (const Tip tip : {Tip::kLeftToes, Tip::kRightToes})
      lowest = std::min(lowest, body.tip(tip).y());
  }
  EXPECT_NEAR(lowest, 0.0f, 1e-4f);
  EXPECT_NE(notes_of(*result).find("the floor was at"), std::string::npos);
  // Where on the floor is nobody's to change: couples are aligned with each other.
  EXPECT_NEAR(result->clip.frames[1].p_WH_m.x(), 0.3f, 1e-4f);
  EXPECT_NEAR(result->clip.frames[1].p_WH_m.z(), 0.2f, 1e-4f);
}

TEST(Retarget, LearnsTheDancersOwnBoneLengths) {
  const auto result = retargeted(test::sample("daz"));
  ASSERT_TRUE(result.has_value()) << result.error().what;
  const Skeleton& s = result->clip.skeleton;
  EXPECT_LT((s.offset(Bone::kLeftLowerArm) - Vector3f(0.28f, 0, 0)).norm(), kMillimetre_m);
  EXPECT_LT((s.offset(Bone::kRightHand) - Vector3f(-0.25f, 0, 0)).norm(), kMillimetre_m);
  EXPECT_LT((s.offset(Bone::kLeftLowerLeg) - Vector3f(0, -0.41f, 0)).norm(), kMillimetre_m);
  EXPECT_LT((s.offset(Bone::kRightFoot) - Vector3f(0, -0.40f, 0)).norm(), kMillimetre_m);
  // Hips to sole: 0.05 + 0.41 + 0.40 + what is below the ankle.
  EXPECT_NEAR(s.hips_height_m(), 0.92f, 2.0f * kMillimetre_m);
}

TEST(Retarget, ClearsThePresenceOfBonesThatTheFileLacks) {
  const auto result = retargeted(test::sample("daz"));
  ASSERT_TRUE(result.has_value()) << result.error().what;
  const std::uint32_t absent = (1u << index_of(Bone::kUpperChest)) |
                               (1u << index_of(Bone::kLeftToes)) |
                               (1u << index_of(Bone::kRightToes));
  for (const Pose& pose : result->clip.frames) {
    EXPECT_EQ(pose.presence, kAllBones & ~absent);
    EXPECT_LT(
        pose.R_PB[index_of(Bone::kUpperChest)].angularDistance(Eigen::Quaternionf::Identity()),
        1e-5f);
  }
}

TEST(Retarget, MakesHandsOfMovingFingers) {
  const auto result = retargeted(test::sample("mixamo"));
  ASSERT_TRUE(result.has_value()) << result.error().what;
  ASSERT_EQ(result->clip.hands.size(), 3u);
  const Hands& step = result->clip.hands[1];
  EXPECT_TRUE(is_valid(step));
  // Left middle finger, first phalanx: 35° down about Z; the right hand is open in this frame.
  const auto turned_deg = [&](std::size_t bone) {
    return 57.2958f * step.R_PB[bone].angularDistance(Eigen::Quaternionf::Identity());
  };
  EXPECT_NEAR(turned_deg(6), 35.0f, 0.5f);
  EXPECT_LT((step.R_PB[6] * Vector3f::UnitX()).y(), -0.5f);
  EXPECT_NEAR(turned_deg(21), 0.0f, 0.5f);
  EXPECT_EQ(step.presence & (1u << 9), 0u) << "the sample has no ring finger";
}

TEST(Retarget, MakesNoHandsOfFingersThatDoNotMove) {
  const auto result = retargeted(test::sample("asf"));
  ASSERT_TRUE(result.has_value()) << result.error().what;
  EXPECT_TRUE(result->clip.hands.empty());
}

TEST(Retarget, GivesValidPosesWithSmoothSigns) {
  for (const std::string style : kStyles) {
    const auto result = retargeted(test::sample(style));
    ASSERT_TRUE(result.has_value()) << style;
    for (std::size_t f = 0; f < result->clip.frames.size(); ++f) {
      const Pose& pose = result->clip.frames[f];
      EXPECT_TRUE(is_valid(pose)) << style;
      const Pose& before = result->clip.frames[f > 0 ? f - 1 : 0];
      for (std::size_t b = 0; b < kBoneCount; ++b)
        EXPECT_GE(pose.R_PB[b].dot(before.R_PB[b]), 0.0f) << style;
    }
  }
}

TEST(Retarget, RefusesAFileWithoutMotion) {
  std::string text = test::sample("vrm");
  text = text.substr(0, text.find("MOTION")) + "MOTION\nFrames: 0\nFrame Time: 0.01\n";
  const auto result = retargeted(text);
  ASSERT_FALSE(result.has_value());
  EXPECT_EQ(result.error().what, "no frames; the file holds a skeleton but no motion");
}

TEST(Retarget, RefusesHipsOffTheStage) {
  RetargetOptions options = heights_kept();
  const auto result =
      retargeted(test::replaced(test::sample("vrm"), "\n0.300000", "\n5000"), options);
  ASSERT_FALSE(result.has_value());
  EXPECT_NE(result.error().what.find("frame 2: the hips are no place on a stage"),
            std::string::npos);
}

TEST(Retarget, TakesPositionsThatRepeatOffsetsAndThoseThatAddToThem) {
  // mixamo.bvh repeats each OFFSET in its position channels; here they are zero instead.
  const auto bvh = read_bvh(test::sample("mixamo"));
  ASSERT_TRUE(bvh.has_value());
  Bvh added = *bvh;
  for (std::size_t f = 0; f < added.frame_count; ++f)
    for (const BvhJoint& joint : added.joints)
      for (std::size_t c = 0; c < joint.channel_count; ++c)
        if (joint.parent >= 0 && is_position(joint.channels[c]))
          added.values[f * added.channel_count + joint.first_channel + c] = 0.0f;
  const auto a = retarget(*bvh);
  const auto b = retarget(added);
  ASSERT_TRUE(a.has_value() && b.has_value());
  for (const Bone bone : {Bone::kLeftHand, Bone::kRightFoot, Bone::kHead})
    EXPECT_LT((body_at(a->clip, 1).position(bone) - body_at(b->clip, 1).position(bone)).norm(),
              kMillimetre_m);
}

}  // namespace
}  // namespace dance
