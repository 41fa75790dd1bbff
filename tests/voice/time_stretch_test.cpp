#include "voice/playout/time_stretch.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "core/base/random.h"
#include "tests/voice/voices.h"

namespace dance {
namespace {

std::vector<float> tone(double hz, std::size_t samples) {
  std::vector<float> out(samples);
  for (std::size_t i = 0; i < samples; ++i)
    out[i] = 0.5f * static_cast<float>(
                        std::sin(2.0 * std::numbers::pi * hz * static_cast<double>(i) / 48'000.0));
  return out;
}

float largest_step(std::span<const float> samples) {
  float step = 0.0f;
  for (std::size_t i = 1; i < samples.size(); ++i)
    step = std::max(step, std::abs(samples[i] - samples[i - 1]));
  return step;
}

TEST(TimeStretch, TakesOutWholePeriodsOfATone) {
  for (const double hz : {110.0, 200.0, 333.0}) {
    auto samples = tone(hz, 1440);
    const float step = largest_step(samples);
    const std::size_t gone = shorten(samples, false);
    ASSERT_GT(gone, 0u) << hz;
    const double periods = static_cast<double>(gone) * hz / 48'000.0;
    EXPECT_NEAR(periods, std::round(periods), 0.03) << hz;
    const auto rest = std::span<const float>(samples).subspan(gone);
    EXPECT_LT(largest_step(rest), 1.1f * step) << "no click at " << hz;
    EXPECT_NEAR(rest[0], 0.0f, 0.03f) << "begins as it would have";
  }
}

TEST(TimeStretch, PutsInWholePeriodsOfATone) {
  for (const double hz : {110.0, 200.0, 333.0}) {
    const auto samples = tone(hz, 1440);
    std::array<float, kLongestPeriod> more{};
    const auto played = std::span(samples).first(720);
    const auto next = std::span(samples).subspan(720);
    const std::size_t count = lengthen(played, next, more, false);
    ASSERT_GT(count, 0u) << hz;
    std::vector<float> all(played.begin(), played.end());
    all.insert(all.end(), more.begin(), more.begin() + static_cast<std::ptrdiff_t>(count));
    all.insert(all.end(), next.begin(), next.end());
    EXPECT_LT(largest_step(all), 1.1f * largest_step(samples)) << "no click at " << hz;
    const double periods = static_cast<double>(count) * hz / 48'000.0;
    EXPECT_NEAR(periods, std::round(periods), 0.03) << hz;
  }
}

TEST(TimeStretch, LeavesNoiseAloneUnlessItMust) {
  Random random(3);
  std::vector<float> noise(1440);
  for (float& sample : noise) sample = static_cast<float>(0.3 * random.uniform(-1.0, 1.0));
  EXPECT_EQ(shorten(noise, false), 0u);
  EXPECT_GT(shorten(noise, true), 0u);
}

TEST(TimeStretch, CutsSilenceAndTooFewSamplesSafely) {
  std::vector<float> silence(960, 0.0f);
  EXPECT_GT(shorten(silence, false), 0u);
  std::array<float, kLongestPeriod> more{};
  EXPECT_GT(lengthen(silence, silence, more, false), 0u);
  std::vector<float> few(100, 0.1f);
  EXPECT_EQ(shorten(few, true), 0u);
  EXPECT_EQ(lengthen(few, few, more, true), 0u);
  EXPECT_EQ(shorten({}, true), 0u);
}

}  // namespace
}  // namespace dance
