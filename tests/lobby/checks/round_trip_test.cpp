#include "lobby/checks/round_trip.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/random.h"
#include "lobby/checks/test_sound.h"

namespace dance {
namespace {

constexpr double kRate_hz = 48'000.0;

struct Room {
  double delay_s = 0.084;
  float gain = 0.2f;
  float noise = 0.0f;
  bool has_reflections = false;
};

std::vector<float> heard_in(const Room& room, std::uint64_t seed = 1) {
  std::vector<float> heard(60'000, 0.0f);
  Random random(seed);
  for (float& sample : heard) sample = room.noise * static_cast<float>(random.normal());
  const auto add = [&](double delay_s, float gain) {
    const auto at = static_cast<std::size_t>(std::lround(delay_s * kRate_hz));
    for (std::size_t i = 0; i < kSweepSamples && at + i < heard.size(); ++i)
      heard[at + i] += gain * test_sweep()[i];
  };
  add(room.delay_s, room.gain);
  if (room.has_reflections)
    for (int k = 1; k < 20; ++k)
      add(room.delay_s + 0.011 * k, room.gain * std::pow(0.75f, static_cast<float>(k)));
  return heard;
}

RoundTrip measured(const std::vector<float>& heard) {
  RoundTripMeter meter;
  const MonoTime begin = MonoTime::from_us(5'000'000);
  meter.begin(begin);
  EXPECT_FALSE(meter.take());
  for (std::size_t at = 0; at < heard.size(); at += 480) {
    const MonoTime read = begin + Duration::seconds(static_cast<double>(at + 480) / kRate_hz);
    meter.hear(std::span(heard).subspan(at, 480), read);
  }
  const auto trip = meter.take();
  EXPECT_TRUE(trip);
  EXPECT_FALSE(meter.take()) << "once";
  EXPECT_FALSE(meter.is_listening());
  return trip.value_or(RoundTrip{});
}

TEST(RoundTrip, FindsTheSweepWhereItIs) {
  const RoundTrip trip = measured(heard_in({}));
  EXPECT_TRUE(trip.is_heard);
  EXPECT_NEAR(trip.delay.as_ms(), 84.0, 0.1);
  EXPECT_NEAR(trip.echo_db, 20.0f * std::log10(0.2f), 0.1f);
  EXPECT_GT(trip.likeness, 0.99f);
}

TEST(RoundTrip, FindsItInNoiseAndReflections) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const RoundTrip trip = measured(heard_in({0.25, 0.05f, 0.01f, true}, seed));
    EXPECT_TRUE(trip.is_heard) << seed;
    EXPECT_NEAR(trip.delay.as_ms(), 250.0, 1.0) << seed;
  }
}

TEST(RoundTrip, NoiseAloneIsNoEcho) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed)
    EXPECT_FALSE(measured(heard_in({0.1, 0.0f, 0.05f, false}, seed)).is_heard) << seed;
}

TEST(RoundTrip, SilenceIsNoEcho) {
  EXPECT_FALSE(measured(heard_in({0.1, 0.0f, 0.0f, false})).is_heard);
}

TEST(TestSound, IsBoundedAndEndsInSilence) {
  float most = 0.0f;
  for (std::int64_t i = -10; i < kCountInSamples + 10; ++i)
    most = std::max(most, std::abs(count_in_sample(i)));
  EXPECT_GT(most, 0.25f);
  EXPECT_LT(most, 0.5f);
  EXPECT_EQ(count_in_sample(-1), 0.0f);
  EXPECT_EQ(count_in_sample(kCountInSamples), 0.0f);
  EXPECT_NEAR(test_sweep().front(), 0.0f, 1e-3f);
  EXPECT_NEAR(test_sweep().back(), 0.0f, 1e-3f);
}

}  // namespace
}  // namespace dance
