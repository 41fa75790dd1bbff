#include "research/beats/song_mastering.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "producers/music/tracker/onset_strength.h"
#include "tests/producers/music/drum_music.h"

namespace dance {
namespace {

constexpr double kStudio_hz = 22050.0;

std::vector<float> strengths_of(const std::vector<float>& music) {
  OnsetStrength onsets(kStudio_hz);
  std::vector<float> strengths;
  for (std::span<const float> left(music); left.size() >= onsets.hop_samples();
       left = left.subspan(onsets.hop_samples())) {
    const auto groups = onsets.push(left.first(onsets.hop_samples()));
    strengths.push_back(0.0f);
    for (std::size_t g = 0; g + 1 < kOnsetGroups; ++g) strengths.back() += groups[g];
  }
  return strengths;
}

// Where it is strongest within a sixth of a second of a hop.
std::size_t stroke_near(const std::vector<float>& strengths, std::size_t hop) {
  const auto first = strengths.begin() + static_cast<std::ptrdiff_t>(hop);
  return static_cast<std::size_t>(std::max_element(first - 8, first + 9) - strengths.begin());
}

// Energy of the change from sample to sample against that of the samples: how bright it is.
double brightness(const std::vector<float>& music) {
  double changes = 0.0, all = 1e-9;
  for (std::size_t i = 1; i < music.size(); ++i) {
    changes += (music[i] - music[i - 1]) * (music[i] - music[i - 1]);
    all += music[i] * music[i];
  }
  return changes / all;
}

TEST(Mastering, LeavesStrokesWhereTheyWereAndMakesThemSoundElsewise) {
  const std::vector<float> music = DrumMusic(kStudio_hz).clicks(DrumMusic::steady(8.0, 120.0), 8.0);
  const std::vector<float> plain = strengths_of(music);
  std::set<double> sounds;
  for (std::uint64_t studio = 1; studio <= 12; ++studio) {
    const std::vector<float> other = mastered(music, kStudio_hz, studio);
    ASSERT_EQ(other.size(), music.size());
    const std::vector<float> heard = strengths_of(other);
    // The first second settles.
    for (double beat_s = 1.3; beat_s < 7.5; beat_s += 0.5) {
      const auto hop = static_cast<std::size_t>(beat_s * 100.0);
      EXPECT_NEAR(static_cast<double>(stroke_near(heard, hop)),
                  static_cast<double>(stroke_near(plain, hop)), 1.0)
          << studio << " " << beat_s;
    }
    sounds.insert(brightness(other));
    EXPECT_EQ(mastered(music, kStudio_hz, studio), other);
  }
  ASSERT_EQ(sounds.size(), 12u);
  EXPECT_GT(*sounds.rbegin(), 1.25 * *sounds.begin());
}

TEST(Mastering, TakesSilenceAndNothing) {
  EXPECT_TRUE(mastered({}, kStudio_hz, 1).empty());
  for (const float sample : {0.0f, 1e-30f, 1e30f})
    for (const float x : mastered(std::vector<float>(100, sample), kStudio_hz, 3)) {
      EXPECT_TRUE(std::isfinite(x)) << sample;
      EXPECT_LE(std::abs(x), 1.1f) << sample;
    }
}

}  // namespace
}  // namespace dance
