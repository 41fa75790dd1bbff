#include "core/pose/interpolate.h"

#include <gtest/gtest.h>

#include "tests/core_pose/random_pose.h"

namespace dance {
namespace {

using Eigen::AngleAxisf;
using Eigen::Quaternionf;
using Eigen::Vector3f;

TEST(Interpolate, GivesItsEnds) {
  Random random(41);
  for (int i = 0; i < 200; ++i) {
    Pose a = random_pose(random), b = random_pose(random);
    a.capture_time = MonoTime::from_us(1000);
    b.capture_time = MonoTime::from_us(3000);
    const Pose at_a = interpolate(a, b, 0.0f), at_b = interpolate(a, b, 1.0f);
    EXPECT_LT(largest_angle_rad(at_a, a), 2e-3f);
    EXPECT_LT(largest_angle_rad(at_b, b), 2e-3f);
    EXPECT_TRUE(at_a.p_WH_m.isApprox(a.p_WH_m));
    EXPECT_TRUE(at_b.p_WH_m.isApprox(b.p_WH_m));
    EXPECT_EQ(at_a.capture_time, a.capture_time);
    EXPECT_EQ(at_b.capture_time, b.capture_time);
  }
}

TEST(Interpolate, TurnsEvenlyAndTheShortWay) {
  Random random(42);
  for (int i = 0; i < 500; ++i) {
    Pose a = random_pose(random), b = random_pose(random);
    // The same rotation as its negative: the way must not depend on the sign.
    for (auto& rotation : b.R_PB)
      if (random.below(2) == 0) rotation.coeffs() = -rotation.coeffs();
    const auto fraction = static_cast<float>(random.uniform());
    const Pose between = interpolate(a, b, fraction);
    EXPECT_TRUE(is_valid(between));
    for (std::size_t bone = 0; bone < kBoneCount; ++bone) {
      const float whole_rad = a.R_PB[bone].angularDistance(b.R_PB[bone]);
      EXPECT_LE(whole_rad, 3.1416f);
      EXPECT_NEAR(a.R_PB[bone].angularDistance(between.R_PB[bone]), fraction * whole_rad, 3e-3f);
      EXPECT_NEAR(between.R_PB[bone].norm(), 1.0f, 1e-5f);
    }
  }
}

TEST(Interpolate, GoesOnBeyondItsEnds) {
  Pose a, b;
  b.R_PB[5] = AngleAxisf(0.2f, Vector3f::UnitX());
  b.p_WH_m = a.p_WH_m + Vector3f(1, 0, 0);
  a.capture_time = MonoTime::from_us(1000);
  b.capture_time = MonoTime::from_us(2000);
  const Pose after = interpolate(a, b, 2.0f);
  EXPECT_TRUE(is_same_rotation(after.R_PB[5], Quaternionf(AngleAxisf(0.4f, Vector3f::UnitX()))));
  EXPECT_TRUE(after.p_WH_m.isApprox(a.p_WH_m + Vector3f(2, 0, 0)));
  EXPECT_EQ(after.capture_time, MonoTime::from_us(3000));
  const Pose before = interpolate(a, b, -1.0f);
  EXPECT_TRUE(is_same_rotation(before.R_PB[5], Quaternionf(AngleAxisf(-0.2f, Vector3f::UnitX()))));
  EXPECT_TRUE(before.p_WH_m.isApprox(a.p_WH_m - Vector3f(1, 0, 0)));
}

TEST(Interpolate, KeepsConfidenceWithinItsRange) {
  Pose a, b;
  a.confidence = 0.2f;
  b.confidence = 0.9f;
  EXPECT_FLOAT_EQ(interpolate(a, b, 0.5f).confidence, 0.55f);
  EXPECT_FLOAT_EQ(interpolate(a, b, 3.0f).confidence, 1.0f);
  EXPECT_FLOAT_EQ(interpolate(a, b, -3.0f).confidence, 0.0f);
}

TEST(Interpolate, HasMusicalTimeOnlyWhereBothHaveIt) {
  Pose a, b;
  a.music_beats = 4.0;
  EXPECT_TRUE(std::isnan(interpolate(a, b, 0.5f).music_beats));
  b.music_beats = 5.0;
  EXPECT_DOUBLE_EQ(interpolate(a, b, 0.25f).music_beats, 4.25);
}

TEST(Interpolate, TakesWhatHasNoBetweenFromTheNearer) {
  Pose a, b;
  a.sequence = 7;
  b.sequence = 8;
  b.presence = 3;
  EXPECT_EQ(interpolate(a, b, 0.49f).sequence, 7u);
  EXPECT_EQ(interpolate(a, b, 0.49f).presence, kAllBones);
  EXPECT_EQ(interpolate(a, b, 0.51f).sequence, 8u);
  EXPECT_EQ(interpolate(a, b, 0.51f).presence, 3u);
}

TEST(LargestAngle, FindsTheOneBoneThatDiffers) {
  Pose a, b;
  EXPECT_NEAR(largest_angle_rad(a, b), 0.0f, 1e-6f);
  b.R_PB[17] = AngleAxisf(0.3f, Vector3f::UnitY());
  b.R_PB[3] = AngleAxisf(0.1f, Vector3f::UnitY());
  EXPECT_NEAR(largest_angle_rad(a, b), 0.3f, 1e-4f);
  b.R_PB[17].coeffs() = -b.R_PB[17].coeffs();
  EXPECT_NEAR(largest_angle_rad(a, b), 0.3f, 1e-4f);
}

}  // namespace
}  // namespace dance
