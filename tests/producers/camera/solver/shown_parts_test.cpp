// What corrects the shown pose, part by part: refused facings, turns, the floor, hands.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "producers/camera/solver/shown/facing.h"
#include "producers/camera/solver/shown/floor_lift.h"
#include "producers/camera/solver/shown/steady_hands.h"
#include "tests/producers/camera/solver/seen_dance.h"

namespace dance {
namespace {

constexpr double kRound_rad = 2.0 * std::numbers::pi;

TEST(FlipWatch, RefusesAJumpUnlessItLasts) {
  FlipWatch watch;
  constexpr double kStep_s = 1.0 / 30.0;
  EXPECT_EQ(watch.judge(0.0, 0.0, false, false, kStep_s, kStep_s), FacingVerdict::kPlausible);
  int refused = 0;
  while (refused < 60 &&
         watch.judge(2.5, 2.5, true, false, kStep_s, kStep_s) == FacingVerdict::kRefused)
    ++refused;
  EXPECT_GE(refused, 10);
  EXPECT_LE(refused, 14);
  // It is undone: that was no body's turn, and the way back is not refused for long.
  refused = 0;
  while (refused < 60 &&
         watch.judge(0.0, -2.5, true, false, kStep_s, kStep_s) == FacingVerdict::kRefused)
    ++refused;
  EXPECT_GE(refused, 1);
  EXPECT_LE(refused, 3);
  // What was seen to turn step by step is no flip: the expectation is behind.
  FlipWatch slow;
  for (int i = 0; i < 60; ++i)
    EXPECT_EQ(slow.judge(0.05 * i, 0.05 * i, i > 20, false, kStep_s, kStep_s),
              FacingVerdict::kPlausible);
  EXPECT_FALSE(FlipWatch::is_far(1.2, 0.2));  // unseen for so long a body may have turned
  EXPECT_TRUE(FlipWatch::is_far(1.2, kStep_s));
  EXPECT_TRUE(FlipWatch::is_suspect(0.6, kStep_s));
  EXPECT_FALSE(FlipWatch::is_suspect(0.6, 2.0 * kStep_s));  // at 15 pictures a second
}

// The tracked facing is wrong, the network right but for one picture in six.
TEST(FlipWatch, RefusesNoTrueFacingForGood) {
  FlipWatch watch;
  constexpr double kStep_s = 1.0 / 30.0;
  double off_rad = 2.8;  // of what is seen, from what is tracked
  int right = 0;
  for (int i = 0; i < 180; ++i) {
    const bool is_flipped = i % 6 == 5;
    const double turn_rad = off_rad - (is_flipped ? 2.8 : 0.0);
    const bool is_far = std::abs(turn_rad) > 0.4;
    if (watch.judge(is_flipped ? 0.0 : 2.8, turn_rad, is_far, is_far, kStep_s, kStep_s) ==
        FacingVerdict::kLasting)
      off_rad -= turn_rad;
    right += i >= 60 && std::abs(off_rad) < 0.1 ? 1 : 0;
  }
  EXPECT_EQ(right, 120);
}

// A body that turned while it was not seen, and turns back at once.
TEST(FlipWatch, ATurnWhileUnseenIsSoonUndone) {
  FlipWatch watch;
  constexpr double kStep_s = 1.0 / 30.0;
  EXPECT_EQ(watch.judge(2.8, 2.8, false, false, kStep_s, 0.4), FacingVerdict::kPlausible);
  int refused = 0;
  while (refused < 60 &&
         watch.judge(0.0, -2.8, true, true, kStep_s, kStep_s) == FacingVerdict::kRefused)
    ++refused;
  EXPECT_LE(refused, 3);
}

TEST(FacingLimit, ATurnThatIsLeftEndsWhereTheFacingIsUnknown) {
  FacingLimit limit;
  const Skeleton skeleton = salsa_skeleton();
  Pose pose = standing();
  limit.apply(skeleton, 1.0 / 30.0, pose);
  pose = standing();
  turn_about_vertical(2.0, pose);
  limit.apply(skeleton, 1.0 / 30.0, pose);
  EXPECT_TRUE(limit.is_behind());
  // It lies on the side: hips and shoulders are above each other.
  const Eigen::Quaternionf side(
      Eigen::AngleAxisf(static_cast<float>(0.25 * kRound_rad), Eigen::Vector3f::UnitZ()));
  for (int i = 0; i < 10; ++i) {
    pose = standing();
    pose.R_PB[0] = side * pose.R_PB[0];
    ASSERT_FALSE(facing_of(skeleton, pose));
    limit.apply(skeleton, 1.0 / 30.0, pose);
  }
  EXPECT_FALSE(limit.is_behind());
  EXPECT_LT(pose.R_PB[0].angularDistance(side), 0.01f);
}

// Of a floor that is not known.
TEST(FloorLift, LyingBodiesLieAndJumpsLeaveTheFloor) {
  const BodyShape shape = shape_of(average_lengths(1.72));
  const auto lowest_m = [&shape](const Pose& pose) {
    BodyFrames frames;
    forward_kinematics(shape.skeleton, pose, frames);
    float lowest = frames.p_WT_m[0].y();
    for (const Eigen::Vector3f& p : frames.p_WB_m) lowest = std::min(lowest, p.y());
    for (const Eigen::Vector3f& p : frames.p_WT_m) lowest = std::min(lowest, p.y());
    return lowest;
  };
  // On the back, the legs raised: thighs upright.
  Pose lying = standing();
  lying.R_PB[0] =
      Eigen::AngleAxisf(static_cast<float>(-0.25 * kRound_rad), Eigen::Vector3f::UnitX());
  for (const Bone thigh : {Bone::kLeftUpperLeg, Bone::kRightUpperLeg})
    lying.R_PB[index_of(thigh)] =
        Eigen::AngleAxisf(static_cast<float>(-0.25 * kRound_rad), Eigen::Vector3f::UnitX());
  lying.p_WH_m.y() = 0.4f;
  FloorLift lift;
  for (int i = 0; i < 30; ++i) {
    Pose pose = lying;
    lift.apply(shape, false, 1.0 / 30.0, pose);
    EXPECT_NEAR(lowest_m(pose), 0.0f, 0.02f) << i;
  }
  lift.clear();
  float highest = 0.0f;
  for (int i = 0; i < 45; ++i) {
    Pose pose = standing();
    const float t = static_cast<float>(i) / 30.0f - 1.0f;  // in the air for half a second
    pose.p_WH_m.y() += t > 0.0f ? std::max(0.0f, 2.45f * t - 4.9f * t * t) : 0.0f;
    lift.apply(shape, false, 1.0 / 30.0, pose);
    EXPECT_GT(lowest_m(pose), -0.005f) << i;
    highest = std::max(highest, lowest_m(pose));
  }
  EXPECT_GT(highest, 0.1f);
}

// A hand before a camera that is far away, of a body that moves by `shift_m`.
class HandScene {
 public:
  explicit HandScene(double hz = 30.0) : hz_(hz) { measurement_.eye_W_m = {0.0f, 1.2f, 3.6f}; }
  // The left wrist beside the hips.
  Eigen::Vector3f show(float shift_m, float arm_rad, float visibility) {
    Pose pose = posture(shift_m, arm_rad);
    measurement_.visibility = {visibility, 1.0f};
    hands_.apply(skeleton_, measurement_, 1.0 / hz_, pose);
    return wrist(pose);
  }
  Eigen::Vector3f wrist_of(float shift_m, float arm_rad) const {
    return wrist(posture(shift_m, arm_rad));
  }
  int frames(double seconds) const { return static_cast<int>(seconds * hz_); }

 private:
  static Pose posture(float shift_m, float arm_rad) {
    Pose pose = standing();
    pose.p_WH_m.x() += shift_m;
    Eigen::Quaternionf& arm = pose.R_PB[index_of(Bone::kLeftUpperArm)];
    arm = Eigen::AngleAxisf(arm_rad, Eigen::Vector3f::UnitZ()) * arm;
    return pose;
  }
  Eigen::Vector3f wrist(const Pose& pose) const {
    BodyFrames frames;
    forward_kinematics(skeleton_, pose, frames);
    return frames.position(Bone::kLeftHand) - pose.p_WH_m;
  }

  double hz_;
  Skeleton skeleton_ = salsa_skeleton();
  SteadyHands hands_;
  SteadyHands::Measurement measurement_;
};

TEST(SteadyHands, AHiddenHandGoesWithTheBodyAndIsLetGo) {
  HandScene scene;
  for (int i = 0; i < 60; ++i) scene.show(0.0f, 0.0f, 1.0f);
  const Eigen::Vector3f was = scene.wrist_of(0.0f, 0.0f);
  // Hidden, the body walks 1.2 m aside in a second, the arm is guessed elsewhere.
  for (int i = 0; i < 27; ++i) {
    const float shift_m = 0.04f * static_cast<float>(i);
    EXPECT_LT((scene.show(shift_m, 0.9f, 0.0f) - was).norm(), 0.2f) << i;
  }
  Eigen::Vector3f shown;
  for (int i = 0; i < 20; ++i) shown = scene.show(1.1f, 0.9f, 0.0f);
  EXPECT_LT((shown - scene.wrist_of(1.1f, 0.9f)).norm(), 0.03f);
}

TEST(SteadyHands, AHandThatIsSeenElsewhereIsThereSoonWithoutAJump) {
  for (const double hz : {15.0, 30.0, 60.0}) {
    HandScene scene(hz);
    for (int i = 0; i < scene.frames(2.0); ++i) scene.show(0.0f, 0.0f, 1.0f);
    Eigen::Vector3f shown;
    for (int i = 0; i < scene.frames(0.4); ++i) shown = scene.show(0.0f, 0.9f, 0.0f);
    float fastest_m_s = 0.0f;
    // Seen, but for one picture in four.
    for (int i = 0; i < scene.frames(1.6); ++i) {
      const Eigen::Vector3f now = scene.show(0.0f, 0.9f, i % 4 == 3 ? 0.0f : 1.0f);
      fastest_m_s = std::max(fastest_m_s, (now - shown).norm() * static_cast<float>(hz));
      shown = now;
    }
    EXPECT_LT((shown - scene.wrist_of(0.0f, 0.9f)).norm(), 0.03f) << hz;
    EXPECT_LT(fastest_m_s, 4.0f) << hz;
  }
}

// A hand that goes elsewhere at once is followed alike at any rate of pictures.
TEST(SteadyHands, OpensAlikeAtAnyRate) {
  std::vector<float> left;
  for (const double hz : {15.0, 30.0, 60.0}) {
    HandScene scene(hz);
    for (int i = 0; i < scene.frames(2.0); ++i) scene.show(0.0f, 0.0f, 1.0f);
    Eigen::Vector3f shown;
    for (int i = 0; i < scene.frames(0.4); ++i) shown = scene.show(0.0f, 0.09f, 1.0f);
    left.push_back((shown - scene.wrist_of(0.0f, 0.09f)).norm());
  }
  EXPECT_NEAR(left[0], left[1], 0.01f);
  EXPECT_NEAR(left[2], left[1], 0.01f);
}

}  // namespace
}  // namespace dance
