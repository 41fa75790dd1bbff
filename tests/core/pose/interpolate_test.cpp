#include "core/pose/interpolate.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "tests/core/pose/random_pose.h"

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

TEST(Interpolate, OfHandsTurnsTheShortWayAndTakesTheRestFromTheNearerOne) {
  Random random(45);
  Hands a, b;
  for (std::size_t i = 0; i < kFingerBoneCount; ++i) {
    a.R_PB[i] = random_rotation(random, 1.0f);
    b.R_PB[i] = random_rotation(random, 1.0f);
    if (i % 2 == 0) b.R_PB[i].coeffs() = -b.R_PB[i].coeffs();
  }
  a.presence = 1;
  b.presence = 2;
  for (const float fraction : {0.0f, 0.25f, 0.75f, 1.0f}) {
    const Hands between = interpolate(a, b, fraction);
    EXPECT_EQ(between.presence, fraction < 0.5f ? 1u : 2u);
    for (std::size_t i = 0; i < kFingerBoneCount; ++i) {
      const float whole_rad = a.R_PB[i].angularDistance(b.R_PB[i]);
      EXPECT_NEAR(a.R_PB[i].angularDistance(between.R_PB[i]), fraction * whole_rad, 3e-3f);
      EXPECT_NEAR(between.R_PB[i].norm(), 1.0f, 1e-5f);
    }
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

// A hand that swings and hips that sway, one after the other as a camera sees them.
Pose swinging(double s) {
  Pose pose;
  pose.capture_time = MonoTime::from_us(1'000'000) + Duration::seconds(s);
  const auto angle = static_cast<float>(1.2 * std::sin(7.0 * s));
  pose.R_PB[5] = Quaternionf(AngleAxisf(0.7f, Vector3f::UnitY())) *
                 Quaternionf(AngleAxisf(angle, Vector3f(1, 2, 3).normalized()));
  pose.p_WH_m = Vector3f(0.1f * angle, 0.9f, 0.3f * std::cos(angle));
  return pose;
}

TEST(InterpolateSmoothly, GivesItsEndsAndValidPosesBetween) {
  Random random(43);
  for (int i = 0; i < 300; ++i) {
    std::array<Pose, 4> poses;
    MonoTime t = MonoTime::from_us(1000);
    for (Pose& pose : poses) {
      pose = random_pose(random, i % 2 == 0 ? 0.3f : 3.14f);
      t += Duration::seconds(random.uniform(0.001, 0.1));
      pose.capture_time = t;
    }
    for (const bool has_before : {false, true})
      for (const bool has_after : {false, true}) {
        const Pose* before = has_before ? &poses[0] : nullptr;
        const Pose* after = has_after ? &poses[3] : nullptr;
        const auto at = [&](float fraction) {
          return interpolate_smoothly(before, poses[1], poses[2], after, fraction);
        };
        EXPECT_LT(largest_angle_rad(at(0.0f), poses[1]), 2e-3f);
        EXPECT_LT(largest_angle_rad(at(1.0f), poses[2]), 2e-3f);
        EXPECT_TRUE(at(0.0f).p_WH_m.isApprox(poses[1].p_WH_m));
        EXPECT_TRUE(at(1.0f).p_WH_m.isApprox(poses[2].p_WH_m));
        const Pose between = at(static_cast<float>(random.uniform()));
        EXPECT_TRUE(is_valid(between));
        for (const auto& rotation : between.R_PB) EXPECT_NEAR(rotation.norm(), 1.0f, 1e-5f);
      }
  }
}

TEST(InterpolateSmoothly, FollowsASwingThatStraightLinesCut) {
  double straight_rad = 0.0, smooth_rad = 0.0, straight_m = 0.0, smooth_m = 0.0;
  for (double s = 0.0; s < 2.0; s += 1.0 / 30.0) {
    // Uneven times, as after losses; and rotations of any sign.
    const Pose before = swinging(s - 1.0 / 15.0), a = swinging(s), after = swinging(s + 1.0 / 15.0);
    Pose b = swinging(s + 1.0 / 30.0);
    b.R_PB[5].coeffs() *= -1.0f;
    for (const float fraction : {0.25f, 0.5f, 0.75f}) {
      const Pose truth = swinging(s + static_cast<double>(fraction) / 30.0);
      const auto add = [&](const Pose& is, double& rad, double& m) {
        rad += static_cast<double>(largest_angle_rad(is, truth));
        m += static_cast<double>((is.p_WH_m - truth.p_WH_m).norm());
      };
      add(interpolate(a, b, fraction), straight_rad, straight_m);
      add(interpolate_smoothly(&before, a, b, &after, fraction), smooth_rad, smooth_m);
    }
  }
  EXPECT_LT(smooth_rad, 0.25 * straight_rad);
  EXPECT_LT(smooth_m, 0.25 * straight_m);
}

TEST(InterpolateSmoothly, HasNoCornerWhereItPassesAPose) {
  const Pose first = swinging(0.0), a = swinging(0.03), b = swinging(0.07), c = swinging(0.1),
             last = swinging(0.12);
  const float h = 1e-2f;
  const Pose before = interpolate_smoothly(&first, a, b, &c, 1.0f - h);
  const Pose after = interpolate_smoothly(&a, b, c, &last, h * 4.0f / 3.0f);
  // Half way between two moments around b lies b.
  const Vector3f corner_m = before.p_WH_m + after.p_WH_m - 2.0f * b.p_WH_m;
  EXPECT_LT(corner_m.norm(), 0.02f * (after.p_WH_m - before.p_WH_m).norm());
  const Pose middle = interpolate(before, after, 0.5f);
  EXPECT_LT(middle.R_PB[5].angularDistance(b.R_PB[5]),
            0.02f * before.R_PB[5].angularDistance(after.R_PB[5]));
}

TEST(InterpolateSmoothly, DoesNotSwingOverWhereAMotionStopsOrStarts) {
  const auto at = [](double s, float x) {
    Pose pose;
    pose.capture_time = MonoTime::from_us(1000) + Duration::seconds(s);
    pose.p_WH_m = Vector3f(x, 0, 0);
    pose.R_PB[7] = AngleAxisf(x, Vector3f::UnitZ());
    return pose;
  };
  // A foot that comes to stand; one that leaves; a step of which most is done at once.
  for (const auto& xs : {std::array{0.0f, 0.3f, 0.3f, 0.3f}, std::array{0.0f, 0.0f, 0.3f, 0.6f},
                         std::array{0.0f, 0.02f, 0.5f, 0.51f}, std::array{0.0f, 0.3f, 0.31f, 0.6f}})
    for (const double gap_s : {0.01, 0.033, 0.09}) {
      const Pose before = at(0.0, xs[0]), a = at(gap_s, xs[1]), b = at(gap_s + 0.033, xs[2]),
                 after = at(gap_s + 0.066, xs[3]);
      for (float fraction = 0.0f; fraction <= 1.0f; fraction += 0.05f) {
        const Pose is = interpolate_smoothly(&before, a, b, &after, fraction);
        const float angle_rad = 2.0f * std::atan2(is.R_PB[7].z(), is.R_PB[7].w());
        for (const float x : {is.p_WH_m.x(), angle_rad}) {
          EXPECT_GE(x, xs[1] - 1e-3f);
          EXPECT_LE(x, xs[2] + 1e-3f);
        }
      }
    }
}

Pose hips_at(double s, const Vector3f& p_m) {
  Pose pose;
  pose.capture_time = MonoTime::from_us(1000) + Duration::seconds(s);
  pose.p_WH_m = p_m;
  return pose;
}

TEST(InterpolateSmoothly, DoesNotSwingOverAlongOneAxisWhileAnotherGoesOn) {
  // Comes down and stands, while it goes on forward; and turns back at the second pose.
  for (const float last_y : {0.0f, 0.1f}) {
    const Pose before = hips_at(0.0, {0.0f, 0.3f, 0.0f}), a = hips_at(0.033, {0.2f, 0.0f, 0.0f}),
               b = hips_at(0.066, {0.4f, 0.0f, 0.0f}), after = hips_at(0.1, {0.6f, last_y, 0.0f});
    for (float fraction = 0.0f; fraction <= 1.0f; fraction += 0.05f) {
      const Pose is = interpolate_smoothly(&before, a, b, &after, fraction);
      EXPECT_NEAR(is.p_WH_m.y(), 0.0f, 1e-6f) << fraction;
      EXPECT_NEAR(is.p_WH_m.x(), 0.2f + 0.2f * fraction, 1e-3f);
    }
  }
}

TEST(InterpolateSmoothly, SwingsOverByLittleWhereItTurnsBack) {
  // Far out and a little back: as fast as it came is too fast for so short a way.
  const Pose before = hips_at(0.0, {-0.4f, 0.0f, 0.0f}), a = hips_at(0.033, {0.5f, 0.0f, 0.0f}),
             b = hips_at(0.066, {0.4f, 0.0f, 0.0f}), after = hips_at(0.1, {0.4f, 0.0f, 0.0f});
  for (float fraction = 0.0f; fraction <= 1.0f; fraction += 0.05f) {
    const float x = interpolate_smoothly(&before, a, b, &after, fraction).p_WH_m.x();
    EXPECT_LE(x, 0.518f);
    EXPECT_GE(x, 0.4f - 1e-4f);
  }
}

TEST(InterpolateSmoothly, HearsNoSpeedFromAPoseNextToAnother) {
  // Half a centimetre within a millisecond is no speed of 5 m/s.
  const Pose before = hips_at(0.032, {0.0f, 0.0f, 0.0f}), a = hips_at(0.033, {0.005f, 0.0f, 0.0f}),
             b = hips_at(0.066, {0.03f, 0.0f, 0.0f}), after = hips_at(0.067, {0.035f, 0.0f, 0.0f});
  for (float fraction = 0.0f; fraction <= 1.0f; fraction += 0.1f)
    EXPECT_NEAR(interpolate_smoothly(&before, a, b, &after, fraction).p_WH_m.x(),
                0.005f + 0.025f * fraction, 1e-5f);
}

TEST(InterpolateSmoothly, GoesTheStraightWayWhereABoneTurnsFar) {
  Random random(44);
  Pose before = random_pose(random), a = random_pose(random), after = random_pose(random);
  before.capture_time = MonoTime::from_us(1000);
  a.capture_time = MonoTime::from_us(2000);
  Pose b = a;
  b.capture_time = MonoTime::from_us(3000);
  after.capture_time = MonoTime::from_us(4000);
  for (auto& rotation : b.R_PB) rotation = rotation * AngleAxisf(1.5f, random_direction(random));
  const Pose straight = interpolate(a, b, 0.3f);
  const Pose smooth = interpolate_smoothly(&before, a, b, &after, 0.3f);
  for (std::size_t bone = 0; bone < kBoneCount; ++bone)
    EXPECT_EQ(smooth.R_PB[bone].coeffs(), straight.R_PB[bone].coeffs());
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
