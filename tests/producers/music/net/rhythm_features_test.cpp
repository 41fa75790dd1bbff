#include "producers/music/tracker/net/rhythm_features.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/allocation_guard.h"
#include "tests/producers/music/drum_music.h"

namespace dance {
namespace {

using Features = std::array<float, RhythmFeatures::kCount>;

// Of each step.
std::vector<Features> features_of(const std::vector<float>& samples, double rate_hz) {
  OnsetStrength onsets(rate_hz);
  RhythmFeatures features(onsets);
  std::vector<Features> all;
  all.reserve(samples.size() / onsets.hop_samples());
  const AllocationGuard guard;
  for (std::size_t at = 0; at + onsets.hop_samples() <= samples.size();
       at += onsets.hop_samples()) {
    if (!features.push(onsets, onsets.push(std::span(samples).subspan(at, onsets.hop_samples()))))
      continue;
    const auto values = features.values();
    std::copy(values.begin(), values.end(), all.emplace_back().begin());
  }
  EXPECT_EQ(guard.allocations(), 0u);
  return all;
}

// Of the bands, in both hops of a step.
float rises(const Features& f) {
  float sum = 0.0f;
  std::size_t at = RhythmFeatures::kBands + RhythmFeatures::kTones;
  for (std::size_t hop = 0; hop < RhythmFeatures::kStep_hops; ++hop, at += kOnsetGroups)
    for (std::size_t b = 0; b < RhythmFeatures::kBands; ++b) sum += f[at++];
  return sum;
}

TEST(RhythmFeatures, ShowAStrokeInTheStepInWhichItBegins) {
  for (const double rate_hz : {44100.0, 48000.0, 22050.0}) {
    const std::vector<double> at_s{1.0, 1.6, 2.2};
    const auto all = features_of(DrumMusic(rate_hz).clicks(at_s, 3.0), rate_hz);
    for (const double click_s : at_s) {
      const double moment = click_s * OnsetStrength::kHops_hz / RhythmFeatures::kStep_hops;
      const auto near = static_cast<std::size_t>(moment);
      double sum = 0.0, moments = 0.0;
      for (std::size_t k = near - 10; k < near + 10; ++k) {
        sum += static_cast<double>(rises(all[k]));
        moments += static_cast<double>(rises(all[k])) * static_cast<double>(k);
      }
      ASSERT_GT(sum, 1.0);
      EXPECT_NEAR(moments / sum, moment + 0.5, 1.0) << rate_hz;
    }
  }
}

TEST(RhythmFeatures, AreFiniteAndNothingInSilence) {
  for (const double rate_hz : {8000.0, 44100.0, 192000.0})
    for (const Features& f :
         features_of(std::vector<float>(static_cast<std::size_t>(0.5 * rate_hz), 0.0f), rate_hz)) {
      for (std::size_t i = 0; i + 1 < f.size(); ++i) ASSERT_EQ(f[i], 0.0f) << rate_hz;
      EXPECT_GT(f.back(), 0.9f) << "it has only begun";
    }
}

TEST(RhythmFeatures, AreTheSameForALouderSong) {
  const auto beats = DrumMusic::steady(6.0, 125.0);
  std::vector<float> samples = DrumMusic(44100.0).play(beats, 6.0);
  const auto quiet = features_of(samples, 44100.0);
  for (float& x : samples) x *= 4.0f;
  const auto loud = features_of(samples, 44100.0);
  for (std::size_t k = 150; k < quiet.size(); ++k)
    for (std::size_t i = 0; i < RhythmFeatures::kCount; ++i)
      ASSERT_NEAR(quiet[k][i], loud[k][i], 0.02f) << k << " " << i;
}

}  // namespace
}  // namespace dance
