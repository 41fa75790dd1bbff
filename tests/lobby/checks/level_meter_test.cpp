#include "lobby/checks/level_meter.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "tests/allocation_guard.h"

namespace dance {
namespace {

std::vector<float> tone(double amplitude, double seconds) {
  std::vector<float> samples(static_cast<std::size_t>(seconds * kCheckRate_hz));
  for (std::size_t i = 0; i < samples.size(); ++i)
    samples[i] = static_cast<float>(amplitude * std::sin(2.0 * std::numbers::pi * 440.0 *
                                                         static_cast<double>(i) / kCheckRate_hz));
  return samples;
}

TEST(LevelMeter, MeasuresAToneAsItIs) {
  LevelMeter meter;
  meter.add(tone(0.1, 1.0));
  EXPECT_NEAR(meter.level().peak_db, -20.0f, 0.1f);
  EXPECT_NEAR(meter.level().rms_db, -23.0f, 0.1f);
  EXPECT_TRUE(meter.level().is_heard);
  EXPECT_FALSE(meter.level().is_silent);
  EXPECT_FALSE(meter.level().clips);
  EXPECT_EQ(meter.level().windows, 20u);
}

TEST(LevelMeter, IsTheSameForPiecesOfAnyLength) {
  const std::vector<float> samples = tone(0.1, 0.5);
  LevelMeter meter;
  for (std::size_t at = 0; at < samples.size(); at += 77)
    meter.add(std::span(samples).subspan(at, std::min<std::size_t>(77, samples.size() - at)));
  EXPECT_NEAR(meter.level().rms_db, -23.0f, 0.1f);
  EXPECT_EQ(meter.level().windows, 10u);
}

TEST(LevelMeter, HoldsAPeakThenLetsItFall) {
  LevelMeter meter;
  meter.add(tone(0.5, 0.1));
  const float peak = meter.level().held_db;
  EXPECT_NEAR(peak, -6.0f, 0.1f);
  meter.add(tone(0.01, 1.4));
  EXPECT_EQ(meter.level().held_db, peak);
  meter.add(tone(0.01, 0.6));
  EXPECT_LT(meter.level().held_db, peak - 5.0f);
  meter.add(tone(0.01, 5.0));
  EXPECT_NEAR(meter.level().held_db, -40.0f, 0.2f) << "no lower than what is heard";
}

TEST(LevelMeter, ThreeSecondsOfZerosAreSilence) {
  LevelMeter meter;
  meter.add(tone(0.1, 1.0));
  const std::vector<float> zeros(static_cast<std::size_t>(2.9 * kCheckRate_hz));
  meter.add(zeros);
  EXPECT_FALSE(meter.level().is_silent);
  meter.add(std::span(zeros).first(9600));
  EXPECT_TRUE(meter.level().is_silent);
  EXPECT_EQ(meter.level().rms_db, kQuietest_db);
  meter.add(tone(0.01, 0.1));
  EXPECT_FALSE(meter.level().is_silent);
}

TEST(LevelMeter, TheNoiseOfARoomIsNoSilence) {
  LevelMeter meter;
  meter.add(tone(0.001, 5.0));
  EXPECT_FALSE(meter.level().is_silent);
  EXPECT_FALSE(meter.level().is_heard) << "nor a voice";
}

TEST(LevelMeter, SoundThatIsCutOffClipsForThreeSeconds) {
  LevelMeter meter;
  std::vector<float> loud = tone(1.5, 0.1);
  for (float& sample : loud) sample = std::clamp(sample, -1.0f, 1.0f);
  meter.add(loud);
  EXPECT_TRUE(meter.level().clips);
  meter.add(tone(0.1, 2.5));
  EXPECT_TRUE(meter.level().clips);
  meter.add(tone(0.1, 1.0));
  EXPECT_FALSE(meter.level().clips);
}

TEST(LevelMeter, ASinglePeakAtFullScaleDoesNotClip) {
  LevelMeter meter;
  std::vector<float> samples = tone(0.1, 1.0);
  samples[1000] = 1.0f;
  meter.add(samples);
  EXPECT_FALSE(meter.level().clips);
}

TEST(LevelMeter, WhatIsNoNumberIsSilent) {
  LevelMeter meter;
  const std::vector<float> broken(LevelMeter::kWindow, std::numeric_limits<float>::quiet_NaN());
  meter.add(broken);
  EXPECT_EQ(meter.level().rms_db, kQuietest_db);
}

TEST(LevelMeter, AllocatesNothing) {
  LevelMeter meter;
  const std::vector<float> samples = tone(0.1, 0.2);
  AllocationGuard guard;
  meter.add(samples);
  EXPECT_EQ(guard.allocations(), 0u);
}

}  // namespace
}  // namespace dance
