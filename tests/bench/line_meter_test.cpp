// What a line makes of a dance, counted: exact times, by a clock of the test's own.
#include "bench/line/line_meter.h"

#include <gtest/gtest.h>

#include "bench/line/bench_line.h"
#include "tests/allocation_guard.h"

namespace dance {
namespace {

const MonoTime kOrigin = MonoTime::from_us(10'000'000);

MonoTime at(double ms) { return kOrigin + Duration::seconds(ms * 1e-3); }

// As the link hands it over: its clock mapping may be off by any constant.
Pose heard(std::uint32_t sequence, double captured_ms, Duration mapped_off = {}) {
  Pose pose;
  pose.sequence = sequence;
  pose.clock_id = 7;
  pose.capture_time = at(captured_ms) + mapped_off;
  return pose;
}

constexpr double kFrame_ms = 20.0;

// Poses with a constant way, from one number to another; the stage shows between them.
void dance(LineMeter& meter, std::uint32_t from, std::uint32_t to, double way_ms,
           Duration mapped_off = {}) {
  for (std::uint32_t i = from; i <= to; ++i) {
    const double captured_ms = kFrame_ms * i;
    meter.sent(i, at(captured_ms));
    meter.look(Duration::seconds(way_ms * 1e-3), at(captured_ms));
    meter.delivered(heard(i, captured_ms, mapped_off), Duration::ms(40), at(captured_ms + way_ms));
    meter.show(at(captured_ms + way_ms + 5.0));
  }
}

TEST(LineMeter, KnowsNothingOfALineOnWhichNothingCame) {
  LineMeter meter(kOrigin, 10);
  meter.sent(1, at(0));
  meter.show(at(10));
  meter.end_dance(at(1000));
  const LineFigures figures = meter.figures();
  EXPECT_EQ(figures.sent, 1u);
  EXPECT_EQ(figures.delivered, 0u);
  EXPECT_FALSE(figures.has_first);
  EXPECT_TRUE(figures.stage_ages.empty());
  EXPECT_EQ(figures.freezes, 0u);
}

TEST(LineMeter, TellsAgesFromCaptureHoweverTheClockIsMapped) {
  for (const Duration off : {Duration(), Duration::s(3600), -Duration::s(5)}) {
    LineMeter meter(kOrigin, 600);
    dance(meter, 1, 500, 30.0, off);
    meter.end_dance(at(kFrame_ms * 501));
    const LineFigures figures = meter.figures();
    EXPECT_EQ(figures.sent, 500u);
    EXPECT_EQ(figures.delivered, 500u);
    EXPECT_EQ(figures.first, Duration::ms(50));
    EXPECT_EQ(figures.ages.front(), Duration::ms(30));
    EXPECT_EQ(figures.ages.back(), Duration::ms(30));
    // hold waits for the next pose: 30 ms of way and 20 ms until it comes.
    ASSERT_EQ(figures.stage_ages.size(), 500u);
    EXPECT_NEAR(figures.stage_ages[250].as_ms(), 50.0, 0.1);
    EXPECT_EQ(figures.freezes, 0u);
    EXPECT_EQ(figures.worst_gap, Duration::ms(20));
    EXPECT_EQ(figures.older_delivered + figures.older_shown, 0u);
  }
}

TEST(LineMeter, TellsGapsAndHowLongAfterThemTheFirstPoseWasThere) {
  LineMeter meter(kOrigin, 200);
  const Duration way = Duration::ms(10);
  dance(meter, 1, 50, 10.0);  // the last is there at 1010
  meter.look({}, at(1020));
  meter.look({}, at(1300));
  meter.look(way, at(1390));  // what comes now is there at 1400, but nothing decodes until 1450
  meter.look(way, at(1395));
  dance(meter, 72, 100, 10.0);
  const LineFigures figures = meter.figures();
  EXPECT_EQ(figures.worst_gap, Duration::ms(440));
  EXPECT_TRUE(figures.worst_gap_is_over);
  EXPECT_EQ(figures.worst_gap_to_pose, Duration::ms(50));
  EXPECT_EQ(figures.worst_gap_round_trip, Duration::ms(10 + 40));
  EXPECT_EQ(figures.slowest_after_gap, Duration::ms(50));

  // A shorter one with a slower start, and then one that does not end.
  meter.look({}, at(2020));
  meter.look(way, at(2290));
  dance(meter, 120, 125, 10.0);
  EXPECT_EQ(meter.figures().worst_gap, Duration::ms(440));
  EXPECT_EQ(meter.figures().slowest_after_gap, Duration::ms(110));
  meter.end_dance(at(4000));
  EXPECT_EQ(meter.figures().worst_gap, Duration::ms(1490));
  EXPECT_FALSE(meter.figures().worst_gap_is_over);
}

TEST(LineMeter, CountsMomentsAtWhichTheStageStandsStill) {
  LineMeter meter(kOrigin, 400);
  dance(meter, 1, 100, 10.0);
  for (double ms = 2020; ms < 2500; ms += 5) meter.show(at(ms));
  dance(meter, 125, 200, 10.0);
  for (double ms = 4020; ms < 4090; ms += 5) meter.show(at(ms));
  meter.end_dance(at(4090));
  const LineFigures figures = meter.figures();
  EXPECT_EQ(figures.freezes, 1u) << "the second is too short to see";
  // From the moment that shows the pose of 2000 to the first after the one of 2500 came, at 2515.
  EXPECT_NEAR(figures.frozen.as_ms(), 485.0, 10.0);
  EXPECT_EQ(figures.older_shown, 0u);
}

TEST(LineMeter, CountsWhatComesOrShowsAfterSomethingNewer) {
  LineMeter twice(kOrigin, 100);
  dance(twice, 1, 10, 10.0);
  twice.delivered(heard(10, 200.0), {}, at(215));
  twice.delivered(heard(9, 180.0), {}, at(216));
  EXPECT_EQ(twice.figures().older_delivered, 2u);

  // The link says that these follow each other, but they were captured the other way round.
  LineMeter back(kOrigin, 100);
  for (std::uint32_t i = 1; i <= 5; ++i) {
    back.sent(i, at(200.0 - kFrame_ms * i));
    back.delivered(heard(i, 200.0 + kFrame_ms * i), {}, at(200.0 + kFrame_ms * i));
    back.show(at(210.0 + kFrame_ms * i));
  }
  EXPECT_GE(back.figures().older_shown, 3u);
}

TEST(LineMeter, IgnoresWhatWasNeverSentAndTakesNoMoreThanItHasRoomFor) {
  LineMeter meter(kOrigin, 3);
  meter.delivered(heard(2, 0.0), {}, at(1));
  meter.delivered(heard(4'000'000'000, 0.0), {}, at(1));
  meter.sent(0, at(0));
  meter.sent(4, at(0));
  const LineFigures figures = meter.figures();
  EXPECT_EQ(figures.sent + figures.delivered, 0u);
}

TEST(LineMeter, AllocatesNothingWhileItMeasures) {
  LineMeter meter(kOrigin, 600);
  dance(meter, 1, 20, 10.0);
  const AllocationGuard guard;
  dance(meter, 21, 400, 12.0);
  meter.end_dance(at(9000));
  EXPECT_EQ(guard.allocations(), 0u);
}

TEST(BenchLine, FailsWhereAPoseGoesBackOrTheHousesDoNotKnowEachOther) {
  BenchLineResult result;
  result.lines.resize(2);
  result.lines[0].name = "clean";
  result.lines[1].name = "bad";
  result.lines[0].has_converged = result.lines[1].has_converged = true;
  EXPECT_TRUE(check_lines(result));
  result.lines[1].down.figures.older_shown = 1;
  ASSERT_FALSE(check_lines(result));
  EXPECT_NE(check_lines(result).error().what.find("bad: a pose"), std::string::npos);
  result.lines[1].down.figures.older_shown = 0;
  result.lines[1].up.figures.older_delivered = 1;
  EXPECT_FALSE(check_lines(result));
  result.lines[1].up.figures.older_delivered = 0;
  result.lines[0].has_converged = false;
  ASSERT_FALSE(check_lines(result));
  EXPECT_NE(check_lines(result).error().what.find("clean: the houses"), std::string::npos);
}

}  // namespace
}  // namespace dance
