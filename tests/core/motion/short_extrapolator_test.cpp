#include "core/motion/short_extrapolator.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/pose/interpolate.h"
#include "core/pose/kinematics.h"
#include "tests/allocation_guard.h"

namespace dance {
namespace {

using Eigen::AngleAxisf;
using Eigen::Quaternionf;
using Eigen::Vector3f;

const MonoTime kStart = MonoTime::from_us(1'000'000);
const Skeleton kBody = average_skeleton();

// Walks along x at speed_m_s and swings an arm at turn_rad_s.
Pose moving(double t_s, float speed_m_s, float turn_rad_s) {
  Pose pose;
  pose.p_WH_m = Vector3f(speed_m_s * static_cast<float>(t_s), kBody.hips_height_m() + 0.1f, 0.0f);
  pose.R_PB[index_of(Bone::kLeftUpperArm)] =
      AngleAxisf(turn_rad_s * static_cast<float>(t_s), Vector3f::UnitZ());
  return pose;
}

ShortExtrapolator after_60_hz(float speed_m_s, float turn_rad_s, int poses) {
  ShortExtrapolator motion;
  for (int i = 0; i < poses; ++i)
    motion.observe(moving(i / 60.0, speed_m_s, turn_rad_s), kStart + Duration::us(16'667) * i);
  return motion;
}

TEST(ShortExtrapolator, GoesOnAtTheSpeedOfTheLastPoses) {
  const ShortExtrapolator motion = after_60_hz(1.0f, 3.0f, 6);
  const MonoTime newest = kStart + Duration::us(16'667) * 5;
  const Pose held = moving(5 / 60.0, 1.0f, 3.0f);
  const Pose truth = moving(5 / 60.0 + 0.016, 1.0f, 3.0f);
  const Pose told = motion.at(newest + Duration::ms(16), kBody);
  EXPECT_LT((told.p_WH_m - truth.p_WH_m).norm(), 0.15f * (held.p_WH_m - truth.p_WH_m).norm());
  EXPECT_LT(largest_angle_rad(told, truth), 0.15f * largest_angle_rad(held, truth));
}

TEST(ShortExtrapolator, ChangesNothingAtTheMomentOfThePoseNorBefore) {
  const ShortExtrapolator motion = after_60_hz(1.0f, 3.0f, 6);
  const MonoTime newest = kStart + Duration::us(16'667) * 5;
  for (const Duration ago : {Duration(), Duration::ms(5), Duration::s(2)}) {
    const Pose told = motion.at(newest - ago, kBody);
    EXPECT_EQ(told.p_WH_m, moving(5 / 60.0, 1.0f, 3.0f).p_WH_m);
  }
}

TEST(ShortExtrapolator, GoesNoFurtherThanItsBound) {
  const ShortExtrapolator motion = after_60_hz(1.0f, 3.0f, 6);
  const MonoTime newest = kStart + Duration::us(16'667) * 5;
  const Pose furthest = motion.at(newest + ShortExtrapolator::kFurthest, kBody);
  const Pose later = motion.at(newest + Duration::s(30), kBody);
  EXPECT_EQ(furthest.p_WH_m, later.p_WH_m);
  EXPECT_LT(later.p_WH_m.x() - moving(5 / 60.0, 1.0f, 0.0f).p_WH_m.x(), 0.051f);
}

TEST(ShortExtrapolator, HoldsAfterAJumpAndAfterAGap) {
  ShortExtrapolator motion = after_60_hz(1.0f, 0.0f, 6);
  Pose far = moving(0.1, 1.0f, 0.0f);
  far.p_WH_m.x() += 3.0f;  // another place of the stage: no speed of a body
  motion.observe(far, kStart + Duration::ms(100));
  EXPECT_EQ(motion.at(kStart + Duration::ms(130), kBody).p_WH_m, far.p_WH_m);
  motion.observe(moving(0.5, 1.0f, 0.0f), kStart + Duration::s(2));
  EXPECT_EQ(motion.at(kStart + Duration::ms(2030), kBody).p_WH_m, moving(0.5, 1.0f, 0.0f).p_WH_m);
}

TEST(ShortExtrapolator, PutsNoFootThroughTheFloor) {
  ShortExtrapolator motion;
  MonoTime now = kStart;
  Pose pose;
  // Falls towards the floor at 2 m/s; the soles are 1 cm above it at last.
  for (int i = 0; i < 6; ++i, now += Duration::us(16'667)) {
    pose.p_WH_m.y() = kBody.hips_height_m() + 0.01f + 2.0f * static_cast<float>(5 - i) / 60.0f;
    motion.observe(pose, now);
  }
  const auto lowest = [](const Pose& it) {
    BodyFrames frames;
    forward_kinematics(kBody, it, frames);
    float low = 1.0f;
    for (const Vector3f& p : frames.p_WB_m) low = std::min(low, p.y());
    for (const Vector3f& p : frames.p_WT_m) low = std::min(low, p.y());
    return low;
  };
  const float at_last = lowest(pose);
  const Pose told = motion.at(now + Duration::ms(33), kBody);
  EXPECT_LT(told.p_WH_m.y(), pose.p_WH_m.y()) << "it does fall";
  EXPECT_GE(lowest(told), std::min(0.0f, at_last) - 1e-5f);
}

TEST(ShortExtrapolator, LeavesOutPosesThatAreNotNewerAndBeginsAnewWithARestartedSource) {
  ShortExtrapolator motion = after_60_hz(1.0f, 0.0f, 6);
  const MonoTime newest = kStart + Duration::us(16'667) * 5;
  const Pose before = motion.at(newest + Duration::ms(16), kBody);
  motion.observe(moving(0.0, 1.0f, 0.0f), newest - Duration::ms(10));
  EXPECT_EQ(motion.at(newest + Duration::ms(16), kBody).p_WH_m, before.p_WH_m);
  const Pose anew = moving(9.0, 1.0f, 0.0f);
  motion.observe(anew, kStart - Duration::ms(900));
  EXPECT_EQ(motion.at(kStart - Duration::ms(880), kBody).p_WH_m, anew.p_WH_m);
}

TEST(ShortExtrapolator, AllocatesNothingAndKeepsRotationsOfUnitLength) {
  ShortExtrapolator motion = after_60_hz(2.0f, 40.0f, 8);
  const AllocationGuard guard;
  motion.observe(moving(0.14, 2.0f, 40.0f), kStart + Duration::ms(140));
  const Pose told = motion.at(kStart + Duration::ms(180), kBody);
  EXPECT_EQ(guard.allocations(), 0u);
  for (const Quaternionf& q : told.R_PB) EXPECT_NEAR(q.norm(), 1.0f, 1e-5f);
}

}  // namespace
}  // namespace dance
