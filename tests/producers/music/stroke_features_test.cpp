#include "producers/music/tracker/stroke_features.h"

#include <gtest/gtest.h>

#include <numeric>

#include "tests/allocation_guard.h"
#include "tests/producers/music/drum_music.h"

namespace dance {
namespace {

using Features = std::array<float, StrokeFeatures::kCount>;

std::vector<Features> features_of(const std::vector<float>& samples, double rate_hz) {
  OnsetStrength onsets(rate_hz);
  StrokeFeatures features(onsets);
  std::vector<Features> all;
  all.reserve(samples.size() / onsets.hop_samples());
  const AllocationGuard guard;
  for (std::size_t at = 0; at + onsets.hop_samples() <= samples.size();
       at += onsets.hop_samples()) {
    features.push(onsets, onsets.push(std::span(samples).subspan(at, onsets.hop_samples())));
    features.read(all.emplace_back());
  }
  EXPECT_EQ(guard.allocations(), 0u);
  return all;
}

float rises(const Features& f) {
  return std::accumulate(f.begin(), f.begin() + StrokeFeatures::kRises * StrokeFeatures::kBands,
                         0.0f);
}

TEST(StrokeFeatures, ShowAStrokeWhenItsMomentIsJudged) {
  for (const double rate_hz : {44100.0, 48000.0, 22050.0}) {
    const std::vector<double> at_s{1.0, 1.6, 2.2};
    const auto all = features_of(DrumMusic(rate_hz).clicks(at_s, 3.0), rate_hz);
    for (const double click_s : at_s) {
      const auto moment = static_cast<std::size_t>(
          std::lround((click_s + StrokeFeatures::kDelay_s) * OnsetStrength::kHops_hz) - 1);
      double sum = 0.0, moments = 0.0;
      for (std::size_t k = moment - 20; k < moment + 20; ++k) {
        sum += rises(all[k]);
        moments += rises(all[k]) * static_cast<double>(k);
      }
      ASSERT_GT(sum, 1.0);
      // Rises are looked for in the five hops after a moment.
      EXPECT_NEAR(moments / sum, static_cast<double>(moment) - 1.5, 2.5) << rate_hz;
    }
  }
}

TEST(StrokeFeatures, AreFiniteAndNothingInSilence) {
  for (const double rate_hz : {8000.0, 44100.0, 192000.0})
    for (const Features& f :
         features_of(std::vector<float>(static_cast<std::size_t>(0.5 * rate_hz), 0.0f), rate_hz))
      for (const float x : f) ASSERT_EQ(x, 0.0f) << rate_hz;
}

TEST(StrokeFeatures, AreTheSameForALouderSong) {
  const auto beats = DrumMusic::steady(6.0, 125.0);
  std::vector<float> samples = DrumMusic(44100.0).play(beats, 6.0);
  const auto quiet = features_of(samples, 44100.0);
  for (float& x : samples) x *= 4.0f;
  const auto loud = features_of(samples, 44100.0);
  for (std::size_t k = 300; k < quiet.size(); ++k)
    for (std::size_t i = 0; i < StrokeFeatures::kCount; ++i)
      ASSERT_NEAR(quiet[k][i], loud[k][i], 0.02f) << k << " " << i;
}

}  // namespace
}  // namespace dance
