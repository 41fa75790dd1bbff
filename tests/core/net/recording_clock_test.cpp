#include "core/net/clock/recording_clock.h"

#include <gtest/gtest.h>

namespace dance {
namespace {

TEST(RecordingClock, GoesWithTheMonotonicClockFromTheWallTimeOfItsBeginning) {
  constexpr std::int64_t kWall_us = 1'700'000'000'000'000;
  const RecordingClock clock(MonoTime::from_us(2'000'000), kWall_us);
  EXPECT_EQ(clock.wall_us(MonoTime::from_us(2'000'000)), kWall_us);
  EXPECT_EQ(clock.wall_us(MonoTime::from_us(2'016'667)), kWall_us + 16'667);
}

TEST(RecordingClock, BeginsAtTheWallClocksTime) {
  const auto wall_us = [] {
    return std::chrono::duration_cast<std::chrono::microseconds>(
               std::chrono::system_clock::now().time_since_epoch())
        .count();
  };
  const std::int64_t before_us = wall_us();
  const RecordingClock clock;
  const std::int64_t begun_us = clock.wall_us(mono_now());
  // A minute, as the machine may be busy.
  EXPECT_GE(begun_us, before_us - 1'000'000);
  EXPECT_LE(begun_us, wall_us() + 60'000'000);
}

}  // namespace
}  // namespace dance
