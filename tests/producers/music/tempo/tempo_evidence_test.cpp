#include "producers/music/tracker/tempo/tempo_evidence.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/allocation_guard.h"

namespace dance {
namespace {

constexpr double kHop_s = 0.01;
constexpr int kLeast_hops = 28, kPeriods = 56;

// A network's tempi, of which these two are so likely and all others not.
Eigen::VectorXf tempi_with(double one_bpm, double of_one, double other_bpm, double of_other) {
  Eigen::VectorXf tempi = Eigen::VectorXf::Constant(RhythmNet::kTempi, std::log(1e-4f));
  const auto set = [&](double bpm, double p) {
    tempi[std::lround(RhythmNet::place_of_tempo(bpm))] = static_cast<float>(std::log(p));
  };
  set(one_bpm, of_one);
  set(other_bpm, of_other);
  return tempi;
}

class HintedTempo : public testing::Test {
 protected:
  float of_tempo(const TempoEvidence& evidence, double bpm) const {
    const auto period = static_cast<std::size_t>(std::lround(60.0 / bpm / kHop_s)) - kLeast_hops;
    return evidence.of_periods()[period];
  }
  TempoEvidence hinted(const TempoHint& hint) const {
    TempoEvidence evidence(kHop_s, kLeast_hops, kPeriods);
    evidence.set_hint(hint);
    for (int hop = 0; hop < 20; ++hop) evidence.push(unknown(), 1.0f);
    return evidence;
  }
  static Eigen::VectorXf unknown() {
    return Eigen::VectorXf::Constant(RhythmNet::kTempi, -std::log(float{RhythmNet::kTempi}));
  }
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

TEST_F(HintedTempo, AHintDecidesBetweenLevelsThatAreHeardOtherwise) {
  TempoEvidence evidence(kHop_s, kLeast_hops, kPeriods);
  for (int hop = 0; hop < 400; ++hop) evidence.push(tempi_with(96.0, 0.1, 192.0, 0.85), 1.0f);
  EXPECT_LT(of_tempo(evidence, 96.0), of_tempo(evidence, 192.0));
  evidence.set_hint({96.0, 0.75});
  for (int hop = 0; hop < 10; ++hop) evidence.push(tempi_with(96.0, 0.1, 192.0, 0.85), 1.0f);
  EXPECT_GT(of_tempo(evidence, 96.0), of_tempo(evidence, 192.0));
}

TEST_F(HintedTempo, TheLikelierLevelGains) {
  TempoEvidence evidence(kHop_s, kLeast_hops, kPeriods);
  for (int hop = 0; hop < 400; ++hop) evidence.push(tempi_with(96.0, 0.9, 192.0, 0.05), 1.0f);
  EXPECT_GT(of_tempo(evidence, 96.0), of_tempo(evidence, 192.0) + 0.05f);
  EXPECT_EQ(of_tempo(evidence, 130.0), 0.0f) << "a tempo beside both levels is left alone";
  EXPECT_EQ(of_tempo(evidence, 96.0), 0.0f);
}

TEST_F(HintedTempo, AllocatesNothing) {
  TempoEvidence evidence(kHop_s, kLeast_hops, kPeriods);
  const Eigen::VectorXf tempi = tempi_with(96.0, 0.7, 192.0, 0.2);
  const AllocationGuard guard;
  for (int hop = 0; hop < 2000; ++hop) evidence.push(tempi, 1.0f);
  EXPECT_EQ(guard.allocations(), 0u);
}

}  // namespace
}  // namespace dance
