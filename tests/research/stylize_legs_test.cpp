// Legs shown larger and smaller: steps, the hips over them, and knees.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/base/random.h"
#include "core/motion/rotation_vector.h"
#include "core/pose/heading.h"
#include "tests/research/styled_dances.h"

namespace dance {
namespace {

using Eigen::Vector3f;

Style hips_and_legs(double hips, double legs) {
  Style style = style_of(BodyZone::kLegs, legs, 1.0);
  style.gain[index_of(BodyZone::kHips)] = static_cast<float>(hips);
  return style;
}

// Sideways, of the hips over the feet.
double sway_m(const Skeleton& skeleton, const Pose& pose) {
  BodyFrames frames;
  forward_kinematics(skeleton, pose, frames);
  const Vector3f feet =
      0.5f * (frames.position(Bone::kLeftFoot) + frames.position(Bone::kRightFoot));
  return static_cast<double>((heading_turn(pose.R_PB[0]).conjugate() * (pose.p_WH_m - feet)).x());
}

// By how much the sway of a dance is multiplied.
double shown_sway(const StyleTake& take, const Style& style) {
  Stylize filter(style);
  filter.set_body(take.skeleton);
  double n = 0.0, a = 0.0, b = 0.0, aa = 0.0, ab = 0.0;
  for (std::size_t i = 0; i < take.poses.size(); ++i) {
    const double was = sway_m(take.skeleton, take.poses[i]);
    const double is = sway_m(take.skeleton, shown(filter, take.poses[i]));
    if (i < 600) continue;
    n += 1.0;
    a += was;
    b += is;
    aa += was * was;
    ab += was * is;
  }
  return (ab - a * b / n) / (aa - a * a / n);
}

float knee_bend_rad(const Pose& pose, Bone shank) {
  return rotation_vector(pose.R_PB[index_of(shank)]).x();
}

TEST(StylizeLegs, FeetThatStandStayWhereTheyStandWhenLegsAreShownLarger) {
  const StyleTake take = synthetic_sway(60.0);  // nobody steps there
  StylizeEvalOptions options;
  options.zone = BodyZone::kLegs;
  options.gain = 2.0;
  const StylizeEval eval = evaluate_stylize(take, options);
  EXPECT_LT(eval.feet_moved_mm, 0.5);
  EXPECT_LT(eval.bone_length_error_mm, 0.01);
}

TEST(StylizeLegs, StepsAreLargerAndSmallerAndTheFootThatStandsDoesNotSlide) {
  const StyleTake take = salsa_take(60.0, 40.0);
  for (const double gain : {0.5, 1.5}) {
    StylizeEvalOptions options;
    options.zone = BodyZone::kLegs;
    options.gain = gain;
    options.mix = 1.0;
    const StylizeEval eval = evaluate_stylize(take, options);
    EXPECT_GT((eval.measured_gain - 1.0) / (gain - 1.0), 0.4) << gain;
    EXPECT_LT(eval.slide_mm_s, eval.danced_slide_mm_s + 5.0) << gain;
    EXPECT_EQ(eval.other_zones_change_deg, 0.0);
    EXPECT_LT(eval.bone_length_error_mm, 0.01);
  }
}

TEST(StylizeLegs, LegsThatAreAskedBackComeHomeStepByStepAndAreThenAsDancedBitForBit) {
  const StyleTake take = salsa_take(60.0, 30.0);
  Stylize filter{Style()};
  filter.set_body(take.skeleton);
  filter.set_style(style_of(BodyZone::kLegs, 1.7, 1.0));
  Pose before_danced, before;
  bool was_moved = false;
  int plain_from = -1;
  for (int i = 0; i < static_cast<int>(take.poses.size()); ++i) {
    if (i == 900) filter.set_style(Style());
    const Pose& danced = take.poses[static_cast<std::size_t>(i)];
    const Pose out = shown(filter, danced);
    was_moved = was_moved || (out.p_WH_m - danced.p_WH_m).norm() > 0.03f;
    if (i > 0) {
      const Eigen::Vector3f more =
          out.p_WH_m - danced.p_WH_m - (before.p_WH_m - before_danced.p_WH_m);
      ASSERT_LT(more.norm(), 0.04f) << i;  // 2 m/s, and as they come down
    }
    if (i > 900 && is_bit_for_bit(out, danced) && plain_from < 0) plain_from = i;
    ASSERT_TRUE(plain_from < 0 || is_bit_for_bit(out, danced)) << i;
    before = out;
    before_danced = danced;
  }
  EXPECT_TRUE(was_moved);
  EXPECT_GT(plain_from, 900);
}

TEST(StylizeLegs, KneesNeverBendTheOtherWayAndNoJointSnaps) {
  const StyleTake take = salsa_take(60.0, 30.0);
  for (const double gain : {0.0, 0.5, 1.5, 2.0}) {
    Stylize filter(style_of(BodyZone::kLegs, gain, 1.0));
    filter.set_body(take.skeleton);
    Pose before, danced_before;
    for (std::size_t i = 0; i < take.poses.size(); ++i) {
      const Pose& danced = take.poses[i];
      const Pose out = shown(filter, danced);
      for (const Bone shank : {Bone::kLeftLowerLeg, Bone::kRightLowerLeg})
        ASSERT_GT(knee_bend_rad(out, shank), std::min(0.0f, knee_bend_rad(danced, shank)) - 0.03f)
            << gain << " " << i;
      for (std::size_t b = index_of(Bone::kLeftUpperLeg); i > 0 && b < kBoneCount; ++b) {
        const float step = out.R_PB[b].angularDistance(before.R_PB[b]);
        const float danced_step = danced.R_PB[b].angularDistance(danced_before.R_PB[b]);
        ASSERT_LT(step, 0.45f + 3.0f * danced_step) << gain << " " << i << " " << b;
      }
      before = out;
      danced_before = danced;
    }
  }
}

TEST(StylizeLegs, AStraightKneeBendsForwardWhenHipsComeDown) {
  const StyleTake take = synthetic_sway(60.0);
  Random random(3);
  Stylize filter(hips_and_legs(3.0, 1.5));
  filter.set_body(take.skeleton);
  int bent = 0;
  for (std::size_t i = 0; i < 1800; ++i) {
    Pose pose = take.poses[i];
    // Beyond straight by three degrees, as retargeted bodies are, and a sensor's noise.
    for (const Bone shank : {Bone::kLeftLowerLeg, Bone::kRightLowerLeg})
      pose.R_PB[index_of(shank)] =
          exp_rotation(Vector3f(-0.05f + 0.01f * static_cast<float>(random.normal()), 0.0f, 0.0f));
    const Pose out = shown(filter, pose);
    for (const Bone shank : {Bone::kLeftLowerLeg, Bone::kRightLowerLeg}) {
      ASSERT_GT(knee_bend_rad(out, shank), -0.12f) << i;
      bent += knee_bend_rad(out, shank) > 0.1f;
    }
  }
  EXPECT_GT(bent, 100);
}

TEST(StylizeLegs, HipsSwayWithTheLegsAndNeverAgainstTheDance) {
  const StyleTake take = salsa_take(60.0, 40.0);
  EXPECT_NEAR(shown_sway(take, hips_and_legs(1.0, 1.5)), 1.6, 0.25);
  EXPECT_NEAR(shown_sway(take, hips_and_legs(1.0, 0.5)), 0.35, 0.25);
  EXPECT_NEAR(shown_sway(take, hips_and_legs(1.0, 0.0)), 0.0, 0.15);
  EXPECT_NEAR(shown_sway(take, hips_and_legs(0.5, 0.5)), 0.15, 0.2);
  EXPECT_NEAR(shown_sway(take, hips_and_legs(0.0, 0.0)), 0.0, 0.15);
  EXPECT_GT(shown_sway(take, hips_and_legs(1.5, 1.5)),
            shown_sway(take, hips_and_legs(1.0, 1.5)) + 0.2);
}

TEST(StylizeLegs, ALegThatIsNotThereIsLeftAsItCame) {
  StyleTake take = salsa_take(60.0, 15.0);
  Stylize filter(hips_and_legs(1.5, 2.0));
  filter.set_body(take.skeleton);
  for (Pose& pose : take.poses) {
    for (std::size_t b = index_of(Bone::kLeftUpperLeg); b < index_of(Bone::kRightUpperLeg); ++b)
      pose.presence &= ~(1u << b);
    const Pose out = shown(filter, pose);
    for (std::size_t b = index_of(Bone::kLeftUpperLeg); b < index_of(Bone::kRightUpperLeg); ++b)
      ASSERT_EQ(out.R_PB[b].coeffs(), pose.R_PB[b].coeffs());
    ASSERT_LT((out.p_WH_m - pose.p_WH_m).norm(), 0.25f);  // the hips' own sway
  }
}

TEST(StylizeLegs, AZoneThatIsAskedBackLeavesNothingBehind) {
  const StyleTake take = salsa_take(60.0, 30.0);
  for (const BodyZone zone : {BodyZone::kTorso, BodyZone::kArms, BodyZone::kLegs}) {
    Stylize filter{Style()};
    filter.set_body(take.skeleton);
    filter.set_style(style_of(zone, 2.5, 1.0));
    Pose before, danced_before;
    bool was_one = true;
    for (int i = 0; i < static_cast<int>(take.poses.size()); ++i) {
      if (i == 1000) filter.set_style(Style());
      const Pose& danced = take.poses[static_cast<std::size_t>(i)];
      const Pose out = shown(filter, danced);
      const bool is_one = filter.gain(zone) == 1.0f;
      if (is_one && !was_one && i > 1000)
        for (std::size_t b = 0; b < kBoneCount; ++b) {
          const float step = out.R_PB[b].angularDistance(before.R_PB[b]);
          const float danced_step = danced.R_PB[b].angularDistance(danced_before.R_PB[b]);
          EXPECT_LT(step, 0.035f + 2.0f * danced_step) << kZoneNames[index_of(zone)] << " " << b;
        }
      was_one = is_one;
      before = out;
      danced_before = danced;
    }
  }
}

TEST(StylizeLegs, OverAGapFeetStayWhereTheyWereSetDown) {
  StyleTake take = salsa_take(60.0, 40.0);
  Stylize filter(style_of(BodyZone::kLegs, 2.0, 1.0));
  filter.set_body(take.skeleton);
  Vector3f moved = Vector3f::Zero();
  bool was_moved = false;
  for (std::size_t i = 0; i < take.poses.size(); ++i) {
    Pose pose = take.poses[i];
    // The stream stops for two seconds, again and again; the dancer waits.
    pose.capture_time += Duration::s(2 * static_cast<std::int64_t>(i / 300));
    const Vector3f before = moved;
    moved = shown(filter, pose).p_WH_m - pose.p_WH_m;
    ASSERT_TRUE(i == 0 || (moved - before).norm() < 0.07f) << i;
    was_moved = was_moved || moved.norm() > 0.05f;
  }
  EXPECT_TRUE(was_moved);
}

}  // namespace
}  // namespace dance
