// The timing of pictures, with a display, a driver and drawing times that are computed.

#include <gtest/gtest.h>

#include "core/base/random.h"
#include "tests/allocation_guard.h"
#include "viewer/display/display_path.h"
#include "viewer/display/swap_meter.h"

namespace dance {
namespace {

constexpr Duration kTurnPeriod = Duration::us(16'667);
const MonoTime kDisplayStart = MonoTime::from_us(5'000'000);
const MonoTime kPhase = MonoTime::from_us(4'003'210);  // of the display's turns

MonoTime turn_after(MonoTime t, Duration period = kTurnPeriod) {
  const std::int64_t past = (t - kPhase).count_ns() % period.count_ns();
  return t + Duration::ns(period.count_ns() - past);
}

TEST(DisplayClock, FindsPeriodAndPhaseFromReturnsThatComeLate) {
  const Duration period = Duration::us(6'944);  // 144 Hz, and the monitor does not say so
  DisplayClock clock(kTurnPeriod);
  Random random(3);
  MonoTime now = kDisplayStart;
  for (int i = 0; i < 200; ++i) {
    now = turn_after(now, period);
    // Mostly woken within 0.2 ms, now and then much later.
    const double late_us =
        random.uniform() < 0.1 ? 2000.0 * random.uniform() : 200.0 * random.uniform();
    clock.add(now + Duration::seconds(1e-6 * late_us));
  }
  ASSERT_TRUE(clock.is_locked());
  EXPECT_NEAR(clock.period().as_us(), 6944.0, 15.0);
  const MonoTime told = clock.next_after(now + Duration::ms(1));
  EXPECT_NEAR((told - turn_after(now + Duration::ms(1), period)).as_us(), 0.0, 250.0);
}

TEST(DisplayClock, KnowsThePeriodWhereOnlyEverySecondTurnIsHit) {
  DisplayClock clock(kTurnPeriod);
  MonoTime now = turn_after(kDisplayStart);
  for (int i = 0; i < 60; ++i) clock.add(now += kTurnPeriod * 2);
  ASSERT_TRUE(clock.is_locked());
  EXPECT_NEAR(clock.period().as_us(), kTurnPeriod.as_us(), 20.0);
}

TEST(DisplayClock, DoesNotLockOnMomentsWithoutABeat) {
  DisplayClock clock(kTurnPeriod);
  Random random(7);
  MonoTime now = kDisplayStart;
  for (int i = 0; i < 200; ++i)
    clock.add(now += Duration::seconds(0.002 + 0.03 * random.uniform()));
  EXPECT_FALSE(clock.is_locked());
}

// Swap calls return at the display's next turn, as with two buffers; drawing takes 3 to 4 ms.
struct EmulatedRun {
  explicit EmulatedRun(const DisplayPath::Options& options) : path(kTurnPeriod, options) {}

  PictureTimes picture(bool waits, Duration drawing) {
    PictureTimes times;
    times.taken = path.when_to_take(now);
    photon = path.photon_time(times.taken);
    times.drawn = times.taken + drawing;
    times.swapped =
        waits ? turn_after(times.drawn) + Duration::us(60) : times.drawn + Duration::us(20);
    now = times.swapped + Duration::us(30);
    path.on_picture(times);
    return times;
  }
  Duration usual_drawing() {
    return Duration::us(3'000 + static_cast<int>(1000 * random.uniform()));
  }

  DisplayPath path;
  MonoTime now = kDisplayStart;
  MonoTime photon;
  Random random{11};
};

TEST(DisplayPath, TakesPosesJustBeforeTheTurnOnceItKnowsIt) {
  EmulatedRun run({});
  for (int i = 0; i < 200; ++i) run.picture(true, run.usual_drawing());
  ASSERT_EQ(run.path.phase(), DisplayPath::Phase::kLatched);
  const std::uint64_t missed = run.path.missed();
  Duration age;
  MonoTime last;
  for (int i = 0; i < 400; ++i) {
    const PictureTimes times = run.picture(true, run.usual_drawing());
    age += times.swapped - times.taken;
    if (last.is_set()) {
      EXPECT_NEAR((times.swapped - last).as_ms(), kTurnPeriod.as_ms(), 0.2);
    }
    last = times.swapped;
  }
  EXPECT_LT((age / 400).as_ms(), 7.0) << "taken at frame start it would be a whole period";
  EXPECT_LE(run.path.missed() - missed, 4u);
}

TEST(DisplayPath, TakesPosesAtOnceWhereLateLatchingIsOff) {
  DisplayPath::Options options;
  options.is_late_latching = false;
  EmulatedRun run(options);
  for (int i = 0; i < 200; ++i) run.picture(true, run.usual_drawing());
  EXPECT_EQ(run.path.when_to_take(run.now), run.now);
}

// Pictures that nobody wanted late cannot be late: the clock is learnt once.
TEST(DisplayPath, KnowsTheTurnsAllTheTimeWhereLateLatchingIsOff) {
  DisplayPath::Options options;
  options.is_late_latching = false;
  options.latency = Duration::ms(5);
  EmulatedRun run(options);
  for (int i = 0; i < 100; ++i) run.picture(true, run.usual_drawing());
  for (int i = 0; i < 500; ++i) {
    const PictureTimes times = run.picture(true, run.usual_drawing());
    ASSERT_TRUE(run.path.knows_turns()) << "picture " << i;
    ASSERT_EQ(run.path.phase(), DisplayPath::Phase::kAtOnce) << "picture " << i;
    const MonoTime turn = times.swapped - Duration::us(60);
    ASSERT_NEAR((run.photon - turn).as_ms(), 5.0, 0.3) << "picture " << i;
  }
  EXPECT_EQ(run.path.missed(), 0u);
}

TEST(DisplayPath, KeepsTheMonitorsPaceWhereSwapCallsDoNotWait) {
  EmulatedRun run({});
  for (int i = 0; i < 100; ++i) run.picture(false, Duration::ms(2));
  ASSERT_EQ(run.path.phase(), DisplayPath::Phase::kOwnPace);
  const PictureTimes one = run.picture(false, Duration::ms(2));
  const PictureTimes other = run.picture(false, Duration::ms(2));
  EXPECT_EQ(other.taken - one.taken, kTurnPeriod);
}

TEST(DisplayPath, SetsMoreTimeAsideWhenDrawingBecomesSlower) {
  EmulatedRun run({});
  for (int i = 0; i < 200; ++i) run.picture(true, run.usual_drawing());
  for (int i = 0; i < 200; ++i) run.picture(true, Duration::ms(9));
  const std::uint64_t missed = run.path.missed();
  for (int i = 0; i < 200; ++i) run.picture(true, Duration::ms(9));
  EXPECT_EQ(run.path.missed(), missed) << "it has learnt";
  EXPECT_GE(run.path.drawing_time(), Duration::ms(9));
}

TEST(DisplayPath, DrawsEveryTurnOrEverySecondWhenDrawingTakesLongerThanAPeriod) {
  EmulatedRun run({});
  for (int i = 0; i < 300; ++i) run.picture(true, Duration::ms(20));
  MonoTime last = run.picture(true, Duration::ms(20)).swapped;
  for (int i = 0; i < 50; ++i) {
    const MonoTime swapped = run.picture(true, Duration::ms(20)).swapped;
    EXPECT_LE((swapped - last).as_ms(), 3.1 * kTurnPeriod.as_ms());
    last = swapped;
  }
}

TEST(DisplayPath, TellsWhenThePictureWillBeSeen) {
  DisplayPath::Options options;
  options.latency = Duration::ms(5);
  EmulatedRun run(options);
  for (int i = 0; i < 200; ++i) run.picture(true, run.usual_drawing());
  const PictureTimes times = run.picture(true, run.usual_drawing());
  const MonoTime turn = times.swapped - Duration::us(60);
  EXPECT_NEAR((run.photon - turn).as_ms(), 5.0, 0.3);
}

TEST(DisplayPath, AllocatesNothing) {
  EmulatedRun run({});
  const AllocationGuard guard;
  for (int i = 0; i < 300; ++i) run.picture(true, run.usual_drawing());
  EXPECT_EQ(guard.allocations(), 0u);
}

TEST(SwapMeter, DividesTheWayOfAPoseIntoItsStages) {
  SwapMeter meter;
  EXPECT_FALSE(meter.figures(kDisplayStart));
  MonoTime now = kDisplayStart;
  for (int i = 0; i < 100; ++i, now += kTurnPeriod) {
    const PictureTimes times{now + Duration::ms(8), now + Duration::ms(11), now + Duration::ms(12)};
    meter.add(now, now + Duration::ms(5), times);
  }
  const auto figures = meter.figures(now);
  ASSERT_TRUE(figures);
  EXPECT_NEAR(figures->p50_ms, 12.0f, 0.01f);
  EXPECT_NEAR(figures->coming_ms, 5.0f, 0.01f);
  EXPECT_NEAR(figures->waiting_ms, 3.0f, 0.01f);
  EXPECT_NEAR(figures->drawing_ms, 3.0f, 0.01f);
  EXPECT_NEAR(figures->swapping_ms, 1.0f, 0.01f);
  EXPECT_FALSE(meter.figures(now + Duration::s(6))) << "too long ago";
}

}  // namespace
}  // namespace dance
