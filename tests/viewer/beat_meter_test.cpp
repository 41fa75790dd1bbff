#include "viewer/scene/beat_meter.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/allocation_guard.h"

namespace dance {
namespace {

constexpr double kBeatsPerSecond = 3.0;

// Shown `late_s` after it was danced, at 60 Hz for `seconds`.
BeatMeter meter_of(double late_s, double wander_s, double seconds = 5.0,
                   double begin_beats = 40.0) {
  BeatMeter meter;
  for (int i = 0; i < static_cast<int>(60 * seconds); ++i) {
    const double heard = begin_beats + kBeatsPerSecond * i / 60.0;
    const double late = late_s + wander_s * std::sqrt(2.0) * std::sin(0.7 * i);
    meter.add(heard - kBeatsPerSecond * late, heard, kBeatsPerSecond, Duration::seconds(late));
  }
  return meter;
}

TEST(BeatMeter, TellsHowFarBehindTheBeatAndHowMuchItWanders) {
  const auto figures = meter_of(0.120, 0.015).figures();
  ASSERT_TRUE(figures);
  EXPECT_NEAR(figures->behind_ms, 120.0f, 2.0f);
  EXPECT_NEAR(figures->wander_ms, 15.0f, 2.0f);
  ASSERT_TRUE(figures->delay_ms);
  EXPECT_NEAR(*figures->delay_ms, 120.0f, 2.0f);
}

TEST(BeatMeter, AWholeBeatLaterIsOnTheBeatAndStillOld) {
  const auto figures = meter_of(1.0 / kBeatsPerSecond, 0.0).figures();
  ASSERT_TRUE(figures);
  EXPECT_NEAR(figures->behind_ms, 0.0f, 0.1f);
  EXPECT_NEAR(figures->wander_ms, 0.0f, 0.5f);
  EXPECT_NEAR(*figures->delay_ms, 333.3f, 1.0f);
}

TEST(BeatMeter, WhatIsGuessedAheadHasANegativeAge) {
  const auto figures = meter_of(-0.013, 0.0).figures();
  ASSERT_TRUE(figures && figures->delay_ms);
  EXPECT_NEAR(*figures->delay_ms, -13.0f, 0.1f);
  BeatMeter unknown;
  for (int i = 0; i < 20; ++i) unknown.add(i, i, kBeatsPerSecond, std::nullopt);
  EXPECT_FALSE(unknown.figures()->delay_ms) << "a clock that cannot be compared";
}

TEST(BeatMeter, OwnBeatsAreWhereTheyWereShown) {
  const auto figures = meter_of(0.1, 0.0).figures();
  ASSERT_TRUE(figures);
  ASSERT_GE(figures->own_beat_count, 10u);
  for (std::size_t i = 0; i < figures->own_beat_count; ++i) {
    const double off = figures->own_beats[i] - std::floor(figures->own_beats[i]);
    EXPECT_NEAR(off, 0.3, 1e-6) << "a tenth of a second of three beats a second";
    if (i > 0) {
      EXPECT_NEAR(figures->own_beats[i] - figures->own_beats[i - 1], 1.0, 1e-6);
    }
  }
}

TEST(BeatMeter, ForgetsOwnBeatsWhenTheMusicJumps) {
  BeatMeter meter = meter_of(0.0, 0.0);
  meter.add(1000.0, 1000.0, kBeatsPerSecond, std::nullopt);
  EXPECT_EQ(meter.figures()->own_beat_count, 0u);
}

TEST(BeatMeter, SaysNothingOfPosesWithoutMusicNorOfTooFew) {
  BeatMeter meter;
  for (int i = 0; i < 100; ++i) meter.add(std::nan(""), i * 0.05, kBeatsPerSecond, Duration::ms(1));
  EXPECT_FALSE(meter.figures());
  for (int i = 0; i < 7; ++i) meter.add(i * 0.05, i * 0.05, kBeatsPerSecond, std::nullopt);
  EXPECT_FALSE(meter.figures());
  meter.add(0.4, 0.4, kBeatsPerSecond, std::nullopt);
  ASSERT_TRUE(meter.figures());
  EXPECT_FALSE(meter.figures()->delay_ms);
}

TEST(BeatMeter, AllocatesNothing) {
  AllocationGuard guard;
  const BeatMeter meter = meter_of(0.05, 0.01);
  EXPECT_TRUE(meter.figures());
}

}  // namespace
}  // namespace dance
