#include "core/net/one_way_clock.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/base/random.h"

namespace dance {
namespace {

MonoTime at_ms(double ms) { return MonoTime::from_us(7'000'000) + Duration::seconds(ms * 1e-3); }

double ms_of(MonoTime time) { return (time - at_ms(0.0)).as_seconds() * 1e3; }

TEST(OneWayClock, WhatComesLateWasCapturedOnTime) {
  OneWayClock clock;
  Random random(4);
  for (int i = 0; i < 1000; ++i) {
    const double sent_ms = 10.0 * i;
    const double delay_ms = i == 0 ? 0.0 : random.uniform(0.0, 30.0);
    const MonoTime ours = clock.to_ours(500'000 + 10'000 * i, at_ms(sent_ms + delay_ms));
    EXPECT_NEAR(ms_of(ours), sent_ms, 0.01) << i;
  }
  EXPECT_EQ(clock.steps(), 0u);
}

TEST(OneWayClock, NothingIsCapturedAfterItArrived) {
  OneWayClock clock;
  Random random(5);
  for (int i = 0; i < 1000; ++i) {
    const MonoTime received = at_ms(10.0 * i + random.uniform(0.0, 50.0));
    EXPECT_LE(clock.to_ours(10'000 * i, received), received);
  }
}

// 100 ppm apart for ten minutes: 60 ms.
TEST(OneWayClock, FollowsAClockThatRunsSlower) {
  OneWayClock clock;
  double worst_ms = 0.0;
  for (int i = 0; i < 60'000; ++i) {
    const double sent_ms = 10.0 * i;
    const auto theirs_us = static_cast<std::int64_t>(sent_ms * 1000.0 * (1.0 - 100e-6));
    worst_ms =
        std::max(worst_ms, std::abs(ms_of(clock.to_ours(theirs_us, at_ms(sent_ms))) - sent_ms));
  }
  EXPECT_LT(worst_ms, 3.0);
}

TEST(OneWayClock, AClockThatIsSetBeginsAnew) {
  OneWayClock clock;
  clock.to_ours(0, at_ms(0.0));
  EXPECT_NEAR(ms_of(clock.to_ours(5'000'000, at_ms(10.0))), 10.0, 1e-6);
  EXPECT_NEAR(ms_of(clock.to_ours(5'010'000, at_ms(25.0))), 20.0, 0.1);
  EXPECT_EQ(clock.steps(), 1u);
}

// A game engine that hangs for a second lets its clock go on by a third of one only.
TEST(OneWayClock, AClockThatFallsBackByLessThanASecondIsFollowedWithinTwo) {
  for (const double back_ms : {300.0, 667.0, 900.0}) {
    OneWayClock clock;
    Random random(6);
    for (int i = 0; i < 2000; ++i) {
      const double sent_ms = 10.0 * i;
      const double back = i < 500 ? 0.0 : back_ms;
      const auto theirs_us = static_cast<std::int64_t>((sent_ms - back) * 1000.0);
      const MonoTime received = at_ms(sent_ms + random.uniform(0.0, 8.0));
      const MonoTime ours = clock.to_ours(theirs_us, received);
      EXPECT_LE(ours, received);
      if (i >= 620) {
        EXPECT_NEAR(ms_of(ours), sent_ms, 3.0) << back_ms << " ms, " << i;
      }
    }
    EXPECT_EQ(clock.steps(), 1u) << back_ms;
  }
}

// Half a second in which most is late, again and again, is the network.
TEST(OneWayClock, DelaysThatPassAreNoStep) {
  OneWayClock clock;
  Random random(7);
  for (int i = 0; i < 20'000; ++i) {
    const double sent_ms = 10.0 * i;
    const bool is_late = i % 100 >= 40 || random.uniform(0.0, 1.0) < 0.5;
    const double delay_ms = is_late && i % 100 != 70 ? random.uniform(20.0, 100.0) : 1.0;
    const MonoTime ours = clock.to_ours(10'000 * i, at_ms(sent_ms + delay_ms));
    if (i > 100) {
      EXPECT_NEAR(ms_of(ours), sent_ms + 1.0, 0.5) << i;
    }
  }
  EXPECT_EQ(clock.steps(), 0u);
}

TEST(OneWayClock, AFewLateStampsOfASlowSenderAreNoStep) {
  OneWayClock clock;
  for (int i = 0; i < 100; ++i) {
    const double sent_ms = 500.0 * i;
    const double delay_ms = i % 10 >= 6 ? 80.0 : 1.0;
    clock.to_ours(500'000 * i, at_ms(sent_ms + delay_ms));
  }
  EXPECT_EQ(clock.steps(), 0u);
}

// Captures that are newer than all before, of frames at 60 Hz whose stamps a function makes.
template <class Stamp>
int newer_captures(OneWayClock& clock, int frames, const Stamp& stamp_us, double from_ms = 0.0) {
  int newer = 0;
  MonoTime newest;
  for (int i = 0; i < frames; ++i) {
    const double ms = from_ms + i * 1000.0 / 60.0;
    const MonoTime ours = clock.to_ours(stamp_us(ms), at_ms(ms + 5.0));
    EXPECT_LE(ours, at_ms(ms + 5.0));
    if (newest.is_set() && ours <= newest) continue;
    newest = ours;
    ++newer;
  }
  return newer;
}

TEST(OneWayClock, UsesTimesOfArrivalWhenTheSendersClockStandsStill) {
  OneWayClock clock;
  EXPECT_GE(newer_captures(clock, 185, [](double) { return 0; }), 184);
  EXPECT_TRUE(clock.is_unusable());
  EXPECT_EQ(clock.steps(), 0u);
}

TEST(OneWayClock, UsesTimesOfArrivalWhenTheSendersClockTicksInSeconds) {
  OneWayClock clock;
  const auto stamp_us = [](double ms) {
    return std::int64_t{1'000'000} * static_cast<std::int64_t>((ms + 480.0) / 1000.0);
  };
  EXPECT_GE(newer_captures(clock, 600, stamp_us), 599);
  EXPECT_TRUE(clock.is_unusable());
}

// Every other frame has the stamp of the one before.
TEST(OneWayClock, UsesTimesOfArrivalWhenTheSendersClockTicksAtHalfTheFrameRate) {
  OneWayClock clock;
  const auto stamp_us = [](double ms) {
    return static_cast<std::int64_t>(std::floor((ms + 1.0) * 30.0 / 1000.0) * 1e6 / 30.0);
  };
  EXPECT_GE(newer_captures(clock, 600, stamp_us), 595);
  EXPECT_TRUE(clock.is_unusable());
}

TEST(OneWayClock, UsesStampsAgainWhenTheSendersClockRuns) {
  OneWayClock clock;
  newer_captures(clock, 60, [](double) { return 0; });
  ASSERT_TRUE(clock.is_unusable());
  const auto running_us = [](double ms) { return static_cast<std::int64_t>(ms * 1000.0); };
  EXPECT_EQ(newer_captures(clock, 60, running_us, 1000.0), 60);
  EXPECT_FALSE(clock.is_unusable());
  // A frame that the network holds back keeps its capture time.
  const MonoTime held = clock.to_ours(running_us(2000.0), at_ms(2025.0));
  EXPECT_NEAR(ms_of(held), 2005.0, 0.5);
}

TEST(OneWayClock, CopiesOfDatagramsMakeNoClockUnusable) {
  OneWayClock clock;
  for (int i = 0; i < 600; ++i) {
    const double ms = i * 1000.0 / 60.0;
    clock.to_ours(static_cast<std::int64_t>(ms * 1000.0), at_ms(ms));
    clock.to_ours(static_cast<std::int64_t>(ms * 1000.0), at_ms(ms + 1.0));
    // Now and then one takes another way.
    if (i % 10 == 0) clock.to_ours(static_cast<std::int64_t>(ms * 1000.0), at_ms(ms + 12.0));
    EXPECT_FALSE(clock.is_unusable()) << i;
  }
}

TEST(OneWayClock, StampsBeyondAllTimesDoNoHarm) {
  OneWayClock clock;
  for (const std::int64_t theirs_us : {INT64_MAX, INT64_MIN, INT64_MAX / 4000, INT64_MIN / 4000})
    EXPECT_LE(clock.to_ours(theirs_us, at_ms(1.0)), at_ms(1.0));
}

}  // namespace
}  // namespace dance
