#include "producers/music/tracker/onset_strength.h"

#include <gtest/gtest.h>

#include "tests/producers/music/drum_music.h"

namespace dance {
namespace {

constexpr double kOnsetRate_hz = 44100.0;

std::vector<OnsetStrength::Strengths> strengths_of(const std::vector<float>& samples) {
  OnsetStrength onsets(kOnsetRate_hz);
  std::vector<OnsetStrength::Strengths> all;
  for (std::size_t at = 0; at + onsets.hop_samples() <= samples.size(); at += onsets.hop_samples())
    all.push_back(onsets.push(std::span(samples).subspan(at, onsets.hop_samples())));
  return all;
}

TEST(OnsetStrength, ShowsAClickAboutItsDelayLater) {
  const std::vector<double> at_s{1.0, 1.503, 2.006, 2.509};
  const auto all = strengths_of(DrumMusic(kOnsetRate_hz).clicks(at_s, 3.0));
  for (const double click_s : at_s) {
    const auto first = static_cast<std::size_t>(click_s * 100.0) - 5;
    std::size_t strongest = first;
    for (std::size_t k = first; k < first + 20; ++k)
      if (all[k][3] > all[strongest][3]) strongest = k;
    const double end_of_hop_s = static_cast<double>(strongest + 1) / 100.0;
    EXPECT_NEAR(end_of_hop_s - OnsetStrength::kDelay_s, click_s - 0.006, 0.010);
    EXPECT_GT(all[strongest][3], 5.0f);
  }
}

TEST(OnsetStrength, IsOneOnAverage) {
  const auto beats = DrumMusic::steady(20.0, 125.0);
  const auto all = strengths_of(DrumMusic(kOnsetRate_hz).play(beats, 20.0));
  for (std::size_t g = 0; g < kOnsetGroups; ++g) {
    double sum = 0.0;
    for (std::size_t k = 500; k < all.size(); ++k) sum += all[k][g];
    EXPECT_NEAR(sum / static_cast<double>(all.size() - 500), 1.0, 0.25) << g;
  }
}

TEST(OnsetStrength, HasNoneInSilence) {
  for (const auto& strengths : strengths_of(std::vector<float>(44100, 0.0f)))
    for (const float strength : strengths) EXPECT_EQ(strength, 0.0f);
}

TEST(OnsetStrength, HearsAChordChangeWithoutAStroke) {
  // Two chords that fade into each other at 3 s: nothing is struck.
  std::vector<float> music(static_cast<std::size_t>(5.0 * kOnsetRate_hz));
  const auto chord = [](double t, double root_hz) {
    double sum = 0.0;
    for (const double ratio : {1.0, 1.26, 1.5})
      sum += std::sin(2.0 * std::numbers::pi * root_hz * ratio * t);
    return 0.1 * sum;
  };
  for (std::size_t i = 0; i < music.size(); ++i) {
    const double t = static_cast<double>(i) / kOnsetRate_hz;
    const double second = std::clamp((t - 2.97) / 0.06, 0.0, 1.0);
    music[i] = static_cast<float>((1.0 - second) * chord(t, 220.0) + second * chord(t, 261.6));
  }
  const auto all = strengths_of(music);
  std::size_t strongest = 100;
  for (std::size_t k = 100; k < all.size(); ++k)
    if (all[k][4] > all[strongest][4]) strongest = k;
  EXPECT_NEAR(static_cast<double>(strongest + 1) / 100.0 - HarmonyChange::kDelay_s, 3.0, 0.06);
}

}  // namespace
}  // namespace dance
