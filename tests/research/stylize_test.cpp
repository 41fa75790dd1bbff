#include "transformers/style/stylize.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/base/random.h"
#include "research/style/stylize_eval.h"
#include "research/style/stylize_overview.h"
#include "tests/allocation_guard.h"
#include "tests/research/styled_dances.h"
#include "transformers/flow.h"
#include "transformers/style/style_presets.h"

namespace dance {
namespace {

TEST(Stylize, GainsOfKnownSwayAreWhatWasAskedForAtAnyRateOfPoses) {
  for (const double hz : {30.0, 60.0, 120.0}) {
    const StyleTake take = synthetic_sway(hz);
    for (const double gain : {0.0, 0.5, 1.5, 2.0, 3.0}) {
      for (const double mix : {0.0, 1.0}) {
        if (hz != 60.0 && gain != 2.0) continue;
        StylizeEvalOptions options;
        options.gain = gain;
        options.mix = mix;
        const StylizeEval eval = evaluate_stylize(take, options);
        EXPECT_NEAR(eval.measured_gain, gain, std::max(0.01 * gain, 0.01)) << hz << " " << mix;
        EXPECT_TRUE(gain == 0.0 || std::abs(eval.phase_deg) < 0.5) << eval.phase_deg;
        EXPECT_LT(eval.mean_pose_shift_deg, 0.1);
        EXPECT_LT(eval.bone_length_error_mm, 0.01);
        EXPECT_EQ(eval.other_zones_change_deg, 0.0);
        EXPECT_LT(eval.feet_moved_mm, 0.05);
        EXPECT_LT(eval.jerk_ratio, std::max(1.03, gain));
      }
    }
  }
}

TEST(Stylize, EachZoneIsScaledAloneAndOnlyItself) {
  const StyleTake take = synthetic_sway(60.0);
  for (std::size_t z = 0; z < kBodyZones; ++z) {
    StylizeEvalOptions options;
    options.zone = static_cast<BodyZone>(z);
    options.gain = 1.5;
    if (options.zone == BodyZone::kLegs) continue;  // feet stand: tests of their own
    const StylizeEval eval = evaluate_stylize(take, options);
    EXPECT_NEAR(eval.measured_gain, 1.5, 0.015) << kZoneNames[z];
    EXPECT_EQ(eval.other_zones_change_deg, 0.0) << kZoneNames[z];
  }
}

TEST(Stylize, AJointThatIsBeyondItsLimitsAsDancedIsLeftThereByALargerGain) {
  Stylize filter(style_of(BodyZone::kLegs, 2.0, 1.0));
  const std::size_t toes = index_of(Bone::kLeftToes);
  Pose pose;
  pose.R_PB[toes] = Eigen::Quaternionf(Eigen::AngleAxisf(1.9f, Eigen::Vector3f::UnitX()));
  pose.p_WH_m.y() = 1.0f;
  for (int i = 1; i < 300; ++i) {
    pose.capture_time = MonoTime::from_us(16'667 * i);
    const Pose out = shown(filter, pose);
    ASSERT_LT(out.R_PB[toes].angularDistance(pose.R_PB[toes]), 1e-3f) << i;
  }
}

TEST(Stylize, TheOverviewHasEachZoneAtEachMixAndSaysWhatHolds) {
  const StyleTake take = synthetic_sway(60.0);
  StylizeEvalOptions asked;
  asked.gain = 2.0;
  const std::vector<StylizeRow> rows = stylize_overview(std::span(&take, 1), asked);
  ASSERT_EQ(rows.size(), 3 * kBodyZones);
  for (const StylizeRow& row : rows) {
    EXPECT_EQ(row.takes, 1u);
    EXPECT_EQ(row.least_gain, row.most_gain);
    EXPECT_EQ(row.least_gain, row.all.measured_gain);
    // Nobody steps there: of two legs that stand less is to be had.
    EXPECT_EQ(row.takes_within, row.asked.zone == BodyZone::kLegs ? 0u : 1u)
        << kZoneNames[index_of(row.asked.zone)] << " " << row.asked.mix;
  }
  const std::string table = stylize_overview_table(rows), json = stylize_overview_json(rows);
  for (const std::string_view zone : kZoneNames) {
    EXPECT_NE(table.find(zone), std::string::npos) << zone;
    EXPECT_NE(json.find("\"zone\": \"" + std::string(zone)), std::string::npos) << json;
  }
  EXPECT_TRUE(stylize_overview({}, asked).empty());
  EXPECT_EQ(stylize_overview_table({}), "");
}

TEST(Stylize, AllGainsOneLeavesEveryPoseBitForBitWhateverTheWeights) {
  const StyleTake take = salsa_take(60.0, 12.0);
  Style style;
  style.periodic = 3.0f;
  style.dynamic = 0.2f;
  Stylize filter(style);
  filter.set_body(take.skeleton);
  for (const Pose& pose : take.poses) ASSERT_TRUE(is_bit_for_bit(shown(filter, pose), pose));
  const auto flow = Flow::make({"stylize"});
  ASSERT_TRUE(flow);
}

TEST(Stylize, SalsaHipsSwayMoreWithoutMusicTooAndFeetStand) {
  StyleTake take = salsa_take(60.0, 60.0);
  StylizeEvalOptions options;
  options.gain = 1.5;
  options.mix = 0.0;
  options.warm_up_s = 25.0;
  for (const bool untagged : {false, true}) {
    options.untagged = untagged;
    const StylizeEval eval = evaluate_stylize(take, options);
    EXPECT_NEAR(eval.measured_gain, 1.5, untagged ? 0.12 : 0.06);
    EXPECT_LT(eval.mean_pose_shift_deg, 0.3);
    EXPECT_LT(eval.feet_moved_mm, 0.1);
    EXPECT_EQ(eval.other_zones_change_deg, 0.0);
  }
}

TEST(Stylize, AStyleSaidLiveIsComeToGraduallyAndMultipliesTheSessions) {
  const StyleTake take = salsa_take(60.0, 30.0);
  Stylize filter(style_of(BodyZone::kHips, 1.5, 1.0));
  filter.set_body(take.skeleton);
  EXPECT_EQ(filter.gain(BodyZone::kHips), 1.5f);
  float before = 1.5f;
  for (std::size_t i = 0; i < take.poses.size(); ++i) {
    if (i == 600) filter.set_style(style_of(BodyZone::kHips, 2.0, 1.0));
    (void)shown(filter, take.poses[i]);
    const float now = filter.gain(BodyZone::kHips);
    EXPECT_LE(std::abs(now - before), 1.0f / 60.0f + 1e-4f);
    before = now;
  }
  EXPECT_EQ(before, 3.0f);
}

TEST(Stylize, WhatIsNoStyleIsRefusedAndCounted) {
  Stylize filter(style_of(BodyZone::kArms, 1.2, 1.0));
  for (const float wrong : {std::nanf(""), -0.1f, 4.1f, INFINITY}) {
    Style style;
    style.gain[2] = wrong;
    filter.set_style(style);
    style = Style();
    style.dynamic = wrong;
    filter.set_style(style);
  }
  EXPECT_EQ(filter.refused(), 8u);
  Pose pose;
  pose.capture_time = MonoTime::from_us(1);
  EXPECT_TRUE(is_sound(shown(filter, pose)));
  EXPECT_EQ(filter.gain(BodyZone::kShoulders), 1.0f);
}

TEST(Stylize, BonesThatAreNotThereAreNotTouched) {
  StyleTake take = salsa_take(60.0, 10.0);
  Style style;
  style.gain.fill(2.0f);
  Stylize filter(style);
  filter.set_body(take.skeleton);
  const std::size_t head = index_of(Bone::kHead);
  for (Pose& pose : take.poses) {
    pose.presence &= ~(1u << head);
    const Pose out = shown(filter, pose);
    ASSERT_TRUE(is_sound(out));
    ASSERT_TRUE(out.R_PB[head].coeffs() == pose.R_PB[head].coeffs());
  }
}

TEST(Stylize, JumpsInTimeTurnsHalfAroundAndMusicGoneMadLeaveSoundBodiesAndBones) {
  Random random(21);
  const StyleTake take = salsa_take(60.0, 60.0);
  Style style;
  style.gain.fill(3.0f);
  style.periodic = 4.0f;
  style.dynamic = 4.0f;
  Stylize filter(style);
  filter.set_body(take.skeleton);
  std::int64_t ns = 1'000'000'000;
  for (Pose pose : take.poses) {
    ns +=
        random.uniform() < 0.95 ? 16'666'667 : static_cast<std::int64_t>(random.uniform(-5e9, 5e9));
    pose.capture_time = MonoTime::from_ns(ns);
    if (random.uniform() < 0.05) pose.music_beats = random.uniform(-1e12, 1e12);
    if (random.uniform() < 0.05) pose.music_beats = kNoMusic;
    if (random.uniform() < 0.02) pose.clock_id = random.uniform() < 0.5 ? 1 : 2;
    if (random.uniform() < 0.05)
      for (auto& R : pose.R_PB) {
        const auto part = [&] { return static_cast<float>(random.uniform(-1.0, 1.0)); };
        R = Eigen::Quaternionf(part(), part(), part(), part() + 1e-3f).normalized();
      }
    const Pose out = shown(filter, pose);
    ASSERT_TRUE(is_sound(out));
    ASSERT_LT((out.p_WH_m - pose.p_WH_m).norm(), 0.8f);
  }
  EXPECT_GT(filter.restarts(), 5u);
}

TEST(Stylize, AHeldPoseStaysAsItIs) {
  StyleTake take = salsa_take(60.0, 15.0);
  Stylize filter(style_of(BodyZone::kArms, 2.0, 1.0));
  filter.set_body(take.skeleton);
  Pose last;
  for (const Pose& pose : take.poses) last = shown(filter, pose);
  const MonoTime now = take.poses.back().capture_time;
  for (int i = 1; i < 60; ++i) {
    Pose out = take.poses.back();
    filter.apply(now + Duration::ms(16 * i), out);
    for (std::size_t b = 0; b < kBoneCount; ++b)
      ASSERT_LT(out.R_PB[b].angularDistance(last.R_PB[b]), 0.02f) << i;
  }
}

TEST(Stylize, AllocatesNothingAsPosesCome) {
  const StyleTake take = salsa_take(60.0, 8.0, false);
  Style style;
  style.gain.fill(1.4f);
  Stylize filter(style);
  filter.set_body(take.skeleton);
  AllocationGuard guard;
  Pose out;
  for (const Pose& pose : take.poses) {
    filter.observe(pose, pose.capture_time);
    out = pose;
    filter.apply(pose.capture_time, out);
    filter.set_style(style);
  }
  EXPECT_EQ(guard.allocations(), 0u);
}

TEST(Stylize, IsARowOfRoutesWithPresetsAndRefusesWhatIsNoGain) {
  for (const char* text :
       {"stylize", "stylize hips=1.3 arms=1.2 mix=0.5", "stylize preset=cuban head=1"})
    EXPECT_TRUE(Flow::make({text})) << text;
  for (const char* text :
       {"stylize hips", "stylize hips=-1", "stylize hips=3.5", "stylize hips=nan", "stylize nose=2",
        "stylize mix=2", "stylize preset=loud"})
    EXPECT_FALSE(Flow::make({text})) << text;
  const auto unknown = Flow::make({"stylize preset=loud"});
  EXPECT_NE(unknown.error().what.find("cuban"), std::string::npos);
}

TEST(Stylize, InAFlowItShowsThePosesOfTheMomentWithItsGains) {
  auto flow = Flow::make({"hold 0ms", "stylize hips=2 arms=2"});
  ASSERT_TRUE(flow);
  const StyleTake take = salsa_take(60.0, 12.0);
  flow->set_body(take.skeleton);
  float most = 0.0f;
  for (const Pose& pose : take.poses) {
    flow->observe(pose, pose.capture_time);
    Pose out;
    ASSERT_TRUE(flow->sample(pose.capture_time, out));
    most = std::max(most, (out.p_WH_m - pose.p_WH_m).norm());
  }
  EXPECT_GT(most, 0.01f);
}

}  // namespace
}  // namespace dance
