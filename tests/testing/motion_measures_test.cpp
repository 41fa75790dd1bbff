#include "testing/motion/motion_measures.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/core/pose/random_pose.h"

namespace dance {
namespace {

constexpr double kRate_hz = 60.0;

MonoTime frame_time(double frame) { return MonoTime() + Duration::seconds(1.0 + frame / kRate_hz); }

// A dancer who swings the left arm by 0.15 rad about z at 1 Hz and walks along x at `walk_m_s`.
Pose swinging(double t_s, double walk_m_s = 0.0) {
  Pose pose;
  pose.capture_time = MonoTime() + Duration::seconds(1.0 + t_s);
  const auto angle = static_cast<float>(0.15 * std::sin(2.0 * M_PI * t_s));
  pose.R_PB[index_of(Bone::kLeftUpperArm)] =
      Eigen::Quaternionf(Eigen::AngleAxisf(angle, Eigen::Vector3f::UnitZ()));
  pose.p_WH_m.x() = static_cast<float>(walk_m_s * t_s);
  return pose;
}

std::vector<Pose> dance_of(int frames, double late_s = 0.0, double walk_m_s = 0.0) {
  std::vector<Pose> poses;
  for (int i = 0; i < frames; ++i) poses.push_back(swinging(i / kRate_hz - late_s, walk_m_s));
  return poses;
}

TEST(MotionMeasures, BodyErrorDoesNotSeeWhereTheHipsAreAndHowTheyAreTurned) {
  const Skeleton skeleton = average_skeleton();
  Random random(1);
  const Pose a = random_pose(random);
  Pose b = a;
  b.p_WH_m += Eigen::Vector3f(1, 2, 3);
  b.R_PB[0] = random_rotation(random);
  EXPECT_NEAR(body_error_m(skeleton, a, b), 0.0, 1e-5);
}

TEST(MotionMeasures, BodyErrorIsTheMeanOverJoints) {
  // A hand turned at the elbow moves only the hand: one joint of 21, by 2 l sin(angle / 2).
  const Skeleton skeleton = average_skeleton();
  Pose a, b;
  b.R_PB[index_of(Bone::kLeftLowerArm)] =
      Eigen::Quaternionf(Eigen::AngleAxisf(0.6f, Eigen::Vector3f::UnitY()));
  const double length_m = static_cast<double>(skeleton.offset(Bone::kLeftHand).norm());
  EXPECT_NEAR(body_error_m(skeleton, a, b), 2.0 * length_m * std::sin(0.3) / 21.0, 1e-6);
}

TEST(MotionMeasures, WorldErrorOfAShiftIsTheShift) {
  const std::vector<Pose> poses = dance_of(60);
  std::vector<Pose> shifted = poses;
  for (Pose& pose : shifted) pose.p_WH_m.z() += 0.25f;
  const JointTrack a(average_skeleton(), poses, kRate_hz), b(average_skeleton(), shifted, kRate_hz);
  EXPECT_NEAR(world_error_m(a, b, 0, 60), 0.25, 1e-5);
  EXPECT_NEAR(body_error_m(a, b), 0.0, 1e-5);
}

TEST(MotionMeasures, BoneLengthErrorIsZeroUnlessARotationIsNotUnit) {
  std::vector<Pose> poses = dance_of(10);
  EXPECT_LT(JointTrack(average_skeleton(), poses, kRate_hz).bone_length_error_m, 1e-6);
  poses[5].R_PB[index_of(Bone::kLeftUpperArm)] = Eigen::Quaternionf(
      1.05f * Eigen::Quaternionf(Eigen::AngleAxisf(1.0f, Eigen::Vector3f::UnitZ())).coeffs());
  EXPECT_GT(JointTrack(average_skeleton(), poses, kRate_hz).bone_length_error_m, 1e-3);
}

TEST(MotionMeasures, JerkOfASwingIsItsThirdDerivative) {
  // The mean of |A w^3 cos| is 2/pi of A w^3; the joints on the arm lie 0.285 and 0.535 m from the
  // shoulder.
  const JointTrack track(average_skeleton(), dance_of(600), kRate_hz);
  const double w = 2.0 * M_PI;
  const double expected = 2.0 / M_PI * 0.15 * (0.285 + 0.535) * w * w * w / 21.0;
  // The path is bent, which adds to it.
  EXPECT_NEAR(jerk_m_s3(track, Places::kBody) / expected, 1.0, 0.06);
  // Shaking by a millimetre from frame to frame is a hundred times as much.
  std::vector<Pose> shaken = dance_of(600);
  for (std::size_t i = 0; i < shaken.size(); i += 2) shaken[i].p_WH_m.y() += 0.001f;
  EXPECT_NEAR(jerk_m_s3(JointTrack(average_skeleton(), shaken, kRate_hz), Places::kWorld),
              0.004 * 60.0 * 60.0 * 60.0, 30.0);
}

TEST(MotionMeasures, ActivityAndPeakOfAWalkAreItsSpeed) {
  std::vector<Pose> poses;
  for (int i = 0; i < 120; ++i) {
    Pose pose;
    pose.p_WH_m.x() = static_cast<float>(1.5 * i / kRate_hz);
    poses.push_back(pose);
  }
  const JointTrack track(average_skeleton(), poses, kRate_hz);
  EXPECT_NEAR(activity_m_s(track, Places::kWorld), 1.5, 1e-3);
  EXPECT_NEAR(activity_m_s(track, Places::kBody), 0.0, 1e-3);
  EXPECT_NEAR(peak_speed_m_s(track, Places::kWorld, 0, 120), 1.5, 1e-3);
}

TEST(MotionMeasures, FeetThatStandSlideAsFastAsTheBodyIsPushed) {
  const JointTrack still(average_skeleton(), dance_of(120), kRate_hz);
  const Stance stance = stance_of(still);
  EXPECT_TRUE(stance.stands[60][0]);
  EXPECT_NEAR(slide_m_s(still, stance), 0.0, 1e-6);
  const JointTrack pushed(average_skeleton(), dance_of(120, 0.0, 0.4), kRate_hz);
  EXPECT_NEAR(slide_m_s(pushed, stance), 0.4, 1e-3);
  EXPECT_FALSE(stance_of(pushed).stands[60][0]) << "what slides at 0.4 m/s does not stand";
}

TEST(MotionMeasures, AFootInTheAirDoesNotStand) {
  std::vector<Pose> poses = dance_of(120);
  for (std::size_t i = 0; i < 60; ++i) poses[i].p_WH_m.y() += 0.2f;
  const Stance stance = stance_of(JointTrack(average_skeleton(), poses, kRate_hz));
  EXPECT_FALSE(stance.stands[30][0]);
  EXPECT_TRUE(stance.stands[90][0]);
}

TEST(MotionMeasures, EffectiveLagIsFoundBetweenFramesBothWays) {
  const JointTrack truth(average_skeleton(), dance_of(600), kRate_hz);
  for (const double late_s : {0.0, 0.1, 0.0417, -0.05}) {
    const JointTrack late(average_skeleton(), dance_of(600, late_s, 0.3), kRate_hz);
    EXPECT_NEAR(effective_lag_s(late, truth), late_s, 0.004) << late_s;
  }
}

TEST(MotionMeasures, PlayRateReadsTheMomentsThatAreShown) {
  std::vector<Pose> poses(4);
  const double frames[] = {0.0, 1.0, 1.5, 3.5};
  for (std::size_t i = 0; i < 4; ++i) poses[i].capture_time = frame_time(frames[i]);
  const PlayRate rate = play_rate(poses, kRate_hz);
  EXPECT_NEAR(rate.least, 0.5, 1e-6);
  EXPECT_NEAR(rate.mean, 3.5 / 3.0, 1e-6);
  EXPECT_NEAR(rate.most, 2.0, 1e-6);
}

TEST(MotionMeasures, TooFewFramesMeasureNothing) {
  const JointTrack track(average_skeleton(), dance_of(1), kRate_hz);
  EXPECT_EQ(jerk_m_s3(track, Places::kWorld), 0.0);
  EXPECT_EQ(activity_m_s(track, Places::kWorld), 0.0);
  EXPECT_EQ(effective_lag_s(track, track), 0.0);
  EXPECT_EQ(slide_m_s(track, stance_of(track)), 0.0);
  EXPECT_EQ(play_rate({}, kRate_hz).mean, 0.0);
}

}  // namespace
}  // namespace dance
