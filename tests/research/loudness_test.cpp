// Loudness against what the standard states of sines.
#include "research/beats/loudness.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

namespace dance {
namespace {

std::vector<float> sine(double amplitude, double seconds) {
  std::vector<float> stereo;
  for (int n = 0; n < static_cast<int>(48000 * seconds); ++n) {
    const double s = amplitude * std::sin(2.0 * std::numbers::pi * 997.0 * n / 48000.0);
    stereo.insert(stereo.end(), 2, static_cast<float>(s));
  }
  return stereo;
}

TEST(Loudness, MatchesTheStandardForSines) {
  EXPECT_NEAR(loudness_lufs(sine(1.0, 2.0)), 0.0, 0.1);
  EXPECT_NEAR(loudness_lufs(sine(0.1, 2.0)), -20.0, 0.1);
}

TEST(Loudness, DoesNotCountSilence) {
  std::vector<float> stereo = sine(0.1, 4.0);
  stereo.resize(2 * stereo.size());
  EXPECT_NEAR(loudness_lufs(stereo), -20.0, 0.3);
  EXPECT_EQ(loudness_lufs(std::vector<float>(96000)), -70.0);
}

}  // namespace
}  // namespace dance
