#include "producers/music/tracker/tempo/tempo_evidence.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/allocation_guard.h"

namespace dance {
namespace {

constexpr double kHop_s = 0.01;
constexpr int kLeast_hops = 28, kPeriods = 56;

// All groups strike each `every_hops`, the lowest each fourth time.
OnsetStrength::Strengths strokes_at(int hop, int every_hops) {
  OnsetStrength::Strengths strengths{};
  if (hop % every_hops == 0)
    for (std::size_t g = 0; g < kOnsetGroups; ++g)
      strengths[g] = g > 0 || hop % (4 * every_hops) == 0 ? 8.0f : 0.0f;
  return strengths;
}

std::size_t at_lag(std::size_t group, double beats) {
  const auto& lags = RhythmPeriods::kLags_beats;
  const auto found = std::find(lags.begin(), lags.end(), beats);
  return group * lags.size() + static_cast<std::size_t>(found - lags.begin());
}

TEST(RhythmPeriods, AreAlikeAfterABeatAndNotAfterAPart) {
  RhythmPeriods rhythm;
  for (int hop = 0; hop < 800; ++hop) rhythm.push(strokes_at(hop, 48));
  std::array<float, RhythmPeriods::kCount> values;
  rhythm.read(48.0, values);
  EXPECT_GT(values[at_lag(1, 1.0)], 0.8f);
  EXPECT_LT(values[at_lag(1, 0.5)], 0.1f);
  EXPECT_LT(values[at_lag(0, 1.0)], 0.1f) << "the lowest group strikes each fourth time only";
  EXPECT_GT(values[at_lag(0, 4.0)], 0.5f);
  rhythm.read(24.0, values);
  EXPECT_LT(values[at_lag(1, 1.0)], 0.1f);
  EXPECT_GT(values[at_lag(1, 2.0)], 0.8f);
}

TEST(RhythmPeriods, AreNothingBeforeAnythingIsHeard) {
  RhythmPeriods rhythm;
  std::array<float, RhythmPeriods::kCount> values;
  rhythm.push({});
  rhythm.read(40.0, values);
  for (std::size_t i = 0; i + 2 < values.size(); ++i) EXPECT_EQ(values[i], 0.0f);
}

// A network that finds nothing.
class HintedTempo : public testing::Test {
 protected:
  float of_tempo(const TempoEvidence& evidence, double bpm) const {
    const auto period = static_cast<std::size_t>(std::lround(60.0 / bpm / kHop_s)) - kLeast_hops;
    return evidence.of_periods()[period];
  }
  TempoEvidence hinted(const TempoHint& hint) const {
    TempoEvidence evidence(net_, kHop_s, kLeast_hops, kPeriods);
    evidence.set_hint(hint);
    for (int hop = 0; hop < 20; ++hop) evidence.push({}, 1.0f);
    return evidence;
  }
  TempoNet net_;
};

TEST_F(HintedTempo, SpeaksAgainstTheOtherLevelOnly) {
  const TempoEvidence low = hinted({96.0, 1.0});
  EXPECT_LT(of_tempo(low, 192.0), -0.05f);
  EXPECT_GT(of_tempo(low, 96.0), -1e-6f);
  EXPECT_GT(of_tempo(low, 130.0), -0.005f) << "a tempo beside both levels is left alone";
  const TempoEvidence high = hinted({188.0, 1.0});
  EXPECT_LT(of_tempo(high, 94.0), -0.05f);
  EXPECT_GT(of_tempo(high, 188.0), -1e-6f);
}

TEST_F(HintedTempo, CountsAsMuchAsItWeighs) {
  const float whole = of_tempo(hinted({96.0, 1.0}), 192.0);
  EXPECT_NEAR(of_tempo(hinted({96.0, 0.25}), 192.0), 0.25f * whole, 1e-4f);
  EXPECT_EQ(of_tempo(hinted({96.0, 7.0}), 192.0), whole) << "no more than surely";
}

TEST_F(HintedTempo, WhatIsNoTempoIsNoHint) {
  for (const double bpm : {0.0, -96.0, 1e9, std::nan("")})
    EXPECT_EQ(of_tempo(hinted({bpm, 1.0}), 192.0), 0.0f) << bpm;
  for (const double weight : {0.0, -1.0, std::nan("")})
    EXPECT_EQ(of_tempo(hinted({96.0, weight}), 192.0), 0.0f) << weight;
}

TEST_F(HintedTempo, AllocatesNothing) {
  TempoEvidence evidence(net_, kHop_s, kLeast_hops, kPeriods);
  const AllocationGuard guard;
  for (int hop = 0; hop < 2000; ++hop) evidence.push(strokes_at(hop, 40), 1.0f);
  EXPECT_EQ(guard.allocations(), 0u);
}

}  // namespace
}  // namespace dance
