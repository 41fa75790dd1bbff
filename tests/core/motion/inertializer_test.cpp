#include "core/motion/inertializer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/allocation_guard.h"
#include "tests/core/pose/random_pose.h"

namespace dance {
namespace {

constexpr Duration kFrame = Duration::us(16'667);
constexpr MonoTime kBegin = MonoTime::from_us(5'000'000);

Pose standing_at(float x_m) {
  Pose pose;
  pose.p_WH_m.x() = x_m;
  return pose;
}

bool is_identical(const Pose& a, const Pose& b) {
  for (std::size_t i = 0; i < kBoneCount; ++i)
    if (a.R_PB[i].coeffs() != b.R_PB[i].coeffs()) return false;
  return a.p_WH_m == b.p_WH_m;
}

TEST(Inertializer, WithNothingToCorrectLeavesThePoseBitForBit) {
  Inertializer inertializer;
  Random random(1);
  const Pose pose = random_pose(random);
  Pose out = pose;
  inertializer.apply(kBegin, out);
  EXPECT_TRUE(is_identical(out, pose));
}

TEST(Inertializer, ShowsWhatWasAtTheMomentOfTheChangeAndHalfTheDifferenceAfterTheHalfLife) {
  Inertializer inertializer(Duration::ms(80));
  const Pose was = standing_at(0.1f), is = standing_at(0.0f);
  inertializer.add(kBegin, was, is);
  Pose out = is;
  inertializer.apply(kBegin, out);
  EXPECT_NEAR(out.p_WH_m.x(), 0.1f, 1e-6f);
  out = is;
  inertializer.apply(kBegin + Duration::ms(80), out);
  EXPECT_NEAR(out.p_WH_m.x(), 0.05f, 1e-5f);
}

TEST(Inertializer, TurnsEveryBoneFromWhatWasToWhatIs) {
  Random random(2);
  const Pose was = random_pose(random, 0.4f);
  Pose is = was;
  for (auto& q : is.R_PB) q = random_rotation(random, 0.4f) * q;
  Inertializer inertializer;
  inertializer.add(kBegin, was, is);
  Pose out = is;
  inertializer.apply(kBegin, out);
  for (std::size_t b = 0; b < kBoneCount; ++b)
    EXPECT_TRUE(is_same_rotation(out.R_PB[b], was.R_PB[b], 2e-3f)) << b;
  float before = 10.0f;
  for (int i = 1; i < 60; ++i) {
    out = is;
    inertializer.apply(kBegin + kFrame * i, out);
    const float left = out.R_PB[3].angularDistance(is.R_PB[3]);
    EXPECT_LE(left, before + 1e-3f) << "an offset let go at rest never grows";
    before = left;
    for (const auto& q : out.R_PB) EXPECT_NEAR(q.norm(), 1.0f, 1e-4f);
  }
  EXPECT_LT(before, 1e-3f);
}

TEST(Inertializer, IsAtRestAndExactAgainOnceTheOffsetHasDied) {
  Inertializer inertializer;
  Random random(3);
  Pose was = random_pose(random);
  const Pose is = random_pose(random);
  was.p_WH_m = is.p_WH_m + Eigen::Vector3f(0.1f, 0.0f, -0.2f);
  inertializer.add(kBegin, was, is);
  EXPECT_FALSE(inertializer.is_at_rest());
  Pose out = is;
  for (int i = 0; i < 1200; ++i) {
    out = is;
    inertializer.apply(kBegin + kFrame * i, out);
  }
  EXPECT_TRUE(inertializer.is_at_rest());
  EXPECT_TRUE(is_identical(out, is));
}

TEST(Inertializer, CorrectionsAddUp) {
  Inertializer inertializer;
  inertializer.add(kBegin, standing_at(0.3f), standing_at(0.2f));
  inertializer.add(kBegin, standing_at(0.2f), standing_at(0.0f));
  Pose out = standing_at(0.0f);
  inertializer.apply(kBegin, out);
  EXPECT_NEAR(out.p_WH_m.x(), 0.3f, 1e-5f);
}

TEST(Inertializer, DecaysWithTheTimeThatPassedWhateverTheFrames) {
  Inertializer coarse, fine;
  coarse.add(kBegin, standing_at(0.2f), standing_at(0.0f));
  fine.add(kBegin, standing_at(0.2f), standing_at(0.0f));
  Pose a = standing_at(0.0f), b;
  coarse.apply(kBegin + Duration::ms(100), a);
  for (int i = 1; i <= 100; ++i) {
    b = standing_at(0.0f);
    fine.apply(kBegin + Duration::ms(i), b);
  }
  EXPECT_NEAR(a.p_WH_m.x(), b.p_WH_m.x(), 1e-5f);
}

TEST(Inertializer, GoesOnAtTheSpeedOfWhatWasWhereItIsTold) {
  // Going on at 1 m/s, then standing: shown is the way on, slowing down.
  const Duration step = Duration::ms(10);
  Inertializer with_speed, without;
  const Pose is = standing_at(0.0f);
  with_speed.add(kBegin, standing_at(-0.01f), standing_at(0.0f), is, is, step);
  without.add(kBegin, standing_at(0.0f), is);
  Pose a = is, b = is;
  const Duration moment = Duration::ms(2);
  with_speed.apply(kBegin + moment, a);
  without.apply(kBegin + moment, b);
  EXPECT_NEAR(a.p_WH_m.x(), 0.002f, 2e-4f);
  EXPECT_EQ(b.p_WH_m.x(), 0.0f);
  a = is;
  with_speed.apply(kBegin + Duration::s(1), a);
  EXPECT_NEAR(a.p_WH_m.x(), 0.0f, 1e-5f);
}

TEST(Inertializer, TakesMetresAndTurnsBackWithoutADash) {
  Inertializer inertializer;
  const Pose is = standing_at(0.0f);
  Pose was = standing_at(3.0f);
  was.R_PB[0] = Eigen::Quaternionf(Eigen::AngleAxisf(3.0f, Eigen::Vector3f::UnitY()));
  inertializer.add(kBegin, was, is);
  Pose before = was;
  for (int i = 1; i < 600; ++i) {
    Pose out = is;
    inertializer.apply(kBegin + kFrame * i, out);
    const double step_s = kFrame.as_seconds();
    EXPECT_LE((out.p_WH_m - before.p_WH_m).norm(), 2.6 * step_s) << i;
    EXPECT_LE(out.R_PB[0].angularDistance(before.R_PB[0]), 9.5 * step_s) << i;
    before = out;
  }
  EXPECT_NEAR(before.p_WH_m.x(), 0.0f, 1e-3f);
  EXPECT_EQ(inertializer.jumps(), 0u);
}

TEST(Inertializer, ShowsADancerElsewhereAtOnceAndCountsIt) {
  Inertializer inertializer;
  inertializer.add(kBegin, standing_at(0.0f), standing_at(9.0f));
  Pose out = standing_at(9.0f);
  inertializer.apply(kBegin, out);
  EXPECT_EQ(out.p_WH_m.x(), 9.0f);
  EXPECT_EQ(inertializer.jumps(), 1u);
}

TEST(Inertializer, StaysFiniteWhateverTimeDoes) {
  Inertializer inertializer;
  Random random(4);
  MonoTime now = kBegin;
  for (int i = 0; i < 5000; ++i) {
    const Pose was = random_pose(random), is = random_pose(random);
    if (i % 3 == 0) inertializer.add(now, was, is);
    if (i % 7 == 0) inertializer.add(now, was, is, is, was, Duration::ms(i % 5));
    Pose out = is;
    inertializer.apply(now, out);
    ASSERT_TRUE(is_valid(out)) << i;
    ASSERT_LE((out.p_WH_m - is.p_WH_m).norm(), Inertializer::kFurthest_m + 2.0f) << i;
    now += Duration::ms(static_cast<std::int64_t>(random.uniform(-50.0, 70.0)));
    if (i % 100 == 99) now += Duration::s(i % 200 == 99 ? 4'000'000 : -3'999'999);
  }
  Pose broken;
  broken.p_WH_m.x() = std::numeric_limits<float>::quiet_NaN();
  broken.R_PB[4].w() = std::numeric_limits<float>::quiet_NaN();
  inertializer.add(now, broken, Pose());
  Pose out;
  inertializer.apply(now, out);
  EXPECT_TRUE(is_valid(out));
}

TEST(Inertializer, AllocatesNothing) {
  Inertializer inertializer;
  Random random(5);
  const Pose was = random_pose(random), is = random_pose(random);
  AllocationGuard guard;
  for (int i = 0; i < 100; ++i) {
    inertializer.add(kBegin + kFrame * i, was, is);
    Pose out = is;
    inertializer.apply(kBegin + kFrame * i, out);
  }
  EXPECT_EQ(guard.allocations(), 0u);
}

}  // namespace
}  // namespace dance
