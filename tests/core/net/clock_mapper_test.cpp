#include "core/net/clock_mapper.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/random.h"

namespace dance {
namespace {

// Their clock, a line and pings over it.
struct Line {
  std::int64_t offset_us = 123'456'789;  // theirs − ours at begin
  double drift_ppm = 0.0;
  double up_ms = 20.0;
  double down_ms = 20.0;
  double jitter_ms = 0.0;  // on top, exponential, each way by itself
  MonoTime begin = MonoTime::from_us(10'000'000);

  std::int64_t theirs_us(MonoTime ours) const {
    const double elapsed_us = (ours - begin).as_us();
    return ours.since_zero_us() + offset_us + std::llround(elapsed_us * drift_ppm * 1e-6);
  }
  ClockMapper::Sample ping(MonoTime at, Random& random) const {
    const auto delay = [&](double base_ms) {
      const double extra = jitter_ms > 0 ? -jitter_ms * std::log(1.0 - random.uniform()) : 0.0;
      return Duration::seconds((base_ms + extra) * 1e-3);
    };
    const MonoTime there = at + delay(up_ms);
    const MonoTime left = there + Duration::us(30);
    return {at, theirs_us(there), theirs_us(left), left + delay(down_ms)};
  }
};

double error_ms(const ClockMapper& clock, const Line& line, MonoTime at) {
  return (clock.to_ours(line.theirs_us(at)) - at).as_ms();
}

TEST(ClockMapper, IsExactOnASteadySymmetricLine) {
  Line line;
  Random random(1);
  ClockMapper clock;
  EXPECT_FALSE(clock.is_mapped());
  ASSERT_TRUE(clock.add(line.ping(line.begin, random)));
  EXPECT_LT(std::abs(error_ms(clock, line, line.begin)), 0.002);
  EXPECT_EQ(clock.newest_round_trip().count_ms(), 40);
  const MonoTime at = line.begin + Duration::s(3);
  EXPECT_LE(std::abs((clock.to_ours(clock.to_theirs_us(at)) - at).count_us()), 1);
}

TEST(ClockMapper, HalfTheDifferenceOfTheDirectionsIsWhatCannotBeSeen) {
  Line line;
  line.up_ms = 60.0;
  line.down_ms = 20.0;
  Random random(2);
  ClockMapper clock;
  for (int i = 0; i < 20; ++i) clock.add(line.ping(line.begin + Duration::ms(200 * i), random));
  EXPECT_NEAR(error_ms(clock, line, line.begin + Duration::s(4)), -20.0, 0.1);
}

TEST(ClockMapper, FindsTheOffsetThroughOneSidedJitter) {
  Line line;
  line.jitter_ms = 30.0;
  Random random(3);
  ClockMapper clock;
  double worst_ms = 0.0;
  for (int i = 0; i < 1500; ++i) {  // five minutes
    const MonoTime at = line.begin + Duration::ms(200 * i);
    clock.add(line.ping(at, random));
    if (i > 100) worst_ms = std::max(worst_ms, std::abs(error_ms(clock, line, at)));
  }
  // A single exchange is off by 30 ms; the shortest of 64 by an eighth of that.
  EXPECT_LT(worst_ms, 6.0);
}

TEST(ClockMapper, FollowsDriftForAnHourWithoutSteps) {
  Line line;
  line.drift_ppm = 80.0;
  line.jitter_ms = 3.0;
  Random random(4);
  ClockMapper clock;
  double worst_ms = 0.0;
  for (int i = 0; i < 18'000; ++i) {
    const MonoTime at = line.begin + Duration::ms(200 * i);
    const std::int64_t probe_us = line.theirs_us(at);
    const MonoTime before = clock.to_ours(probe_us);
    clock.add(line.ping(at, random));
    if (i <= 20) continue;
    // No sample moves a mapped time by more than a fifth of a millisecond, forwards or back.
    ASSERT_LE(std::abs((clock.to_ours(probe_us) - before).count_us()), 260);
    worst_ms = std::max(worst_ms, std::abs(error_ms(clock, line, at)));
  }
  EXPECT_LT(worst_ms, 2.0);
  EXPECT_EQ(clock.steps(), 0u);
}

TEST(ClockMapper, StepsOnceWhenAClockWasSet) {
  Line line;
  line.jitter_ms = 2.0;
  Random random(5);
  ClockMapper clock;
  MonoTime at = line.begin;
  for (int i = 0; i < 100; ++i) clock.add(line.ping(at += Duration::ms(200), random));
  line.offset_us -= 7'000'000;  // the other machine slept
  for (int i = 0; i < 5; ++i) clock.add(line.ping(at += Duration::ms(200), random));
  EXPECT_LT(std::abs(error_ms(clock, line, at)), 5.0);
  EXPECT_EQ(clock.steps(), 1u);
}

TEST(ClockMapper, OneWildSampleMovesNothing) {
  Line line;
  Random random(6);
  ClockMapper clock;
  MonoTime at = line.begin;
  for (int i = 0; i < 20; ++i) clock.add(line.ping(at += Duration::ms(200), random));
  ClockMapper::Sample wild = line.ping(at += Duration::ms(200), random);
  wild.their_receive_us += 1'000'000;
  wild.their_send_us += 1'000'000;
  clock.add(wild);
  EXPECT_LT(std::abs(error_ms(clock, line, at)), 0.01);
}

TEST(ClockMapper, RefusesSamplesThatCannotBe) {
  ClockMapper clock;
  const MonoTime t = MonoTime::from_us(1'000'000);
  EXPECT_FALSE(clock.add({t, 5000, 4000, t + Duration::ms(1)})) << "left before it came";
  EXPECT_FALSE(clock.add({t, 0, 9000, t + Duration::ms(1)})) << "held longer than it was away";
  EXPECT_FALSE(clock.add({t, 0, 0, t + Duration::s(120)}));
  EXPECT_FALSE(clock.add({t, INT64_MIN, INT64_MIN, t}));
  EXPECT_FALSE(clock.add({t, INT64_MAX, INT64_MAX, t}));
  EXPECT_FALSE(clock.is_mapped());
}

}  // namespace
}  // namespace dance
