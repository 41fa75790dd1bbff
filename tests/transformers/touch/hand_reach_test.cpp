#include <gtest/gtest.h>

#include "core/base/random.h"
#include "tests/transformers/touch/two_dancers.h"

namespace dance {
namespace {

using Eigen::Quaternionf;
using Eigen::Vector3f;

TEST(HandReach, BringsAHandWhereItShouldBeAndKeepsBonesAndTheHandsTurn) {
  Random random(3);
  const Skeleton skeleton = average_skeleton();
  for (int i = 0; i < 200; ++i) {
    const std::size_t side = static_cast<std::size_t>(i % 2);
    Pose pose = standing(0.0f, static_cast<float>(random.uniform(-3.0, 3.0)));
    BodyFrames before, after, kept;
    forward_kinematics(skeleton, pose, before);
    const Vector3f shift(static_cast<float>(random.uniform(-0.1, 0.1)),
                         static_cast<float>(random.uniform(-0.1, 0.1)),
                         static_cast<float>(random.uniform(-0.1, 0.1)));
    kept = before;
    const float left = move_hand(side, shift, pose, kept);
    forward_kinematics(skeleton, pose, after);
    const std::size_t hand = index_of(kArms[side].end);
    EXPECT_NEAR((after.p_WB_m[hand] - before.p_WB_m[hand] - shift).norm(), left, 1e-4f);
    if (left > 0.0f) continue;
    EXPECT_LT((after.p_WB_m[hand] - before.p_WB_m[hand] - shift).norm(), 2e-4f) << i;
    EXPECT_LT(after.R_WB[hand].angularDistance(before.R_WB[hand]), 2e-3f);
    for (std::size_t b = 0; b < kBoneCount; ++b) {
      EXPECT_LT((kept.p_WB_m[b] - after.p_WB_m[b]).norm(), 2e-4f) << kBones[b].name;
      EXPECT_NEAR(pose.R_PB[b].norm(), 1.0f, 1e-5f);
    }
  }
}

TEST(HandReach, ChangesNothingForNoShiftAndLittleForALittleOne) {
  const Skeleton skeleton = average_skeleton();
  const Pose pose = standing(0.0f, 0.4f);
  BodyFrames frames;
  forward_kinematics(skeleton, pose, frames);
  Pose moved = pose;
  EXPECT_EQ(move_hand(0, Vector3f::Zero(), moved, frames), 0.0f);
  for (std::size_t b = 0; b < kBoneCount; ++b)
    EXPECT_EQ(moved.R_PB[b].coeffs(), pose.R_PB[b].coeffs());
  move_hand(0, Vector3f(0.002f, 0.0f, 0.001f), moved, frames);
  for (std::size_t b = 0; b < kBoneCount; ++b)
    EXPECT_LT(moved.R_PB[b].angularDistance(pose.R_PB[b]), 0.03f) << kBones[b].name;
}

TEST(HandReach, StretchesTowardsWhatIsOutOfReachAndSaysHowFarItStays) {
  const Skeleton skeleton = average_skeleton();
  Pose pose = standing(0.0f, 0.0f);
  BodyFrames frames;
  forward_kinematics(skeleton, pose, frames);
  EXPECT_GT(move_hand(1, Vector3f(0.0f, 0.0f, 5.0f), pose, frames), 3.0f);
  for (std::size_t b = 0; b < kBoneCount; ++b) EXPECT_TRUE(pose.R_PB[b].coeffs().allFinite());
  // A straight arm bends again.
  EXPECT_LT(move_hand(1, Vector3f(0.0f, 0.0f, -0.2f), pose, frames), 1e-3f);
}

TEST(HandReach, IgnoresWhatIsNoShift) {
  Pose pose = standing(0.0f, 0.0f);
  const Pose before = pose;
  BodyFrames frames;
  forward_kinematics(average_skeleton(), pose, frames);
  move_hand(0, Vector3f(NAN, 0.0f, 0.0f), pose, frames);
  for (std::size_t b = 0; b < kBoneCount; ++b)
    EXPECT_EQ(pose.R_PB[b].coeffs(), before.R_PB[b].coeffs());
}

// A straight arm that a hand on its way to the shoulder bends: noise of half a degree in the elbow
// does not say to which side.
TEST(HandReach, AStraightArmBendsWhereElbowsDoWhateverItsNoise) {
  for (std::size_t side = 0; side < 2; ++side) {
    const auto upper = index_of(kArms[side].upper), lower = index_of(kArms[side].lower),
               hand = index_of(kArms[side].end);
    Vector3f least = Vector3f::Constant(1e9f), most = -least;
    for (int i = 0; i < 24; ++i) {
      const float angle = 6.2831853f * static_cast<float>(i) / 24.0f;
      Pose pose;
      pose.p_WH_m = {0.0f, 1.0f, 0.0f};
      pose.R_PB[lower] = Quaternionf(Eigen::AngleAxisf(
          0.0087f, Vector3f(0.0f, std::cos(angle), std::sin(angle)).normalized()));
      BodyFrames frames;
      forward_kinematics(average_skeleton(), pose, frames);
      const Vector3f shift = 0.06f * (frames.p_WB_m[upper] - frames.p_WB_m[hand]).normalized();
      EXPECT_LT(move_hand(side, shift, pose, frames), 2e-3f) << side << " " << angle;
      least = least.cwiseMin(frames.p_WB_m[lower]);
      most = most.cwiseMax(frames.p_WB_m[lower]);
    }
    EXPECT_LT((most - least).maxCoeff(), 0.03f) << side;
  }
}

}  // namespace
}  // namespace dance
