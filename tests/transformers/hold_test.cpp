
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <vector>

#include "core/base/random.h"
#include "tests/allocation_guard.h"
#include "tests/transformers/flows.h"

namespace dance {
namespace {

constexpr double kHz = 60.0;

// A dancer whose hips move at 1 m/s along x: what is shown tells which moment it is.
Pose pose_of(MonoTime capture, std::uint64_t clock_id = 1) {
  Pose pose;
  pose.capture_time = capture;
  pose.clock_id = clock_id;
  pose.p_WH_m.x() = static_cast<float>(static_cast<double>(capture.since_zero_ns()) * 1e-9);
  return pose;
}

TEST(Hold, ShowsNothingBeforeTheFirstPose) {
  Hold hold(Duration::ms(20));
  Pose out;
  EXPECT_FALSE(hold.sample(at_ms(5), out));
}

TEST(Hold, ShowsEachMomentAConstantTimeLaterWhateverTheJitter) {
  // The window covers the wait for the next pose (16.7 ms) and its jitter.
  Hold hold(Duration::ms(40));
  Random random(7);
  const double transit_ms = 40.0;
  // Arrivals with 0 to 15 ms of jitter, in order; the stage samples at its own rate in between.
  double next_sample_ms = 200.0, last_arrival_ms = 0.0;
  int checked = 0;
  for (int i = 0; i < 600; ++i) {
    const double capture_ms = 1000.0 / kHz * i;
    const double arrival_ms =
        std::max(last_arrival_ms, capture_ms + transit_ms + (i == 0 ? 0.0 : random.uniform(0, 15)));
    last_arrival_ms = arrival_ms;
    for (; next_sample_ms < arrival_ms; next_sample_ms += 1000.0 / kHz) {
      Pose out;
      ASSERT_TRUE(hold.sample(at_ms(next_sample_ms), out));
      if (next_sample_ms < 3000.0) continue;  // the least transit must have been seen
      const double age_ms =
          next_sample_ms - static_cast<double>(out.capture_time.since_zero_ns()) * 1e-6;
      // The least of 0 to 15 ms of jitter over 5 s is a fraction of a millisecond.
      EXPECT_NEAR(age_ms, transit_ms + 40.0, 0.6);
      EXPECT_NEAR(static_cast<double>(out.p_WH_m.x()), (next_sample_ms - age_ms) * 1e-3, 1e-3);
      ++checked;
    }
    hold.observe(pose_of(at_ms(capture_ms)), at_ms(arrival_ms));
  }
  EXPECT_GT(checked, 300);
}

TEST(Hold, RepeatsTheLastPoseWhenTheNextIsLateAndCountsIt) {
  Hold hold(Duration::ms(0));
  hold.observe(pose_of(at_ms(100)), at_ms(110));
  hold.observe(pose_of(at_ms(116)), at_ms(126));
  Pose out;
  ASSERT_TRUE(hold.sample(at_ms(500), out));
  EXPECT_EQ(out.capture_time, at_ms(116));
  EXPECT_EQ(hold.counters().starved, 1u);
}

TEST(Hold, AbsorbsTheOffsetOfAForeignClock) {
  // A log recorded hours ago, replayed with its old stamps.
  Hold hold(Duration::ms(20));
  const double offset_ms = 5.0 * 3600e3;
  Pose out;
  for (int i = 0; i < 120; ++i) {
    const double now_ms = offset_ms + 1000.0 / kHz * i;
    hold.observe(pose_of(at_ms(1000.0 + 1000.0 / kHz * i)), at_ms(now_ms));
    ASSERT_TRUE(hold.sample(at_ms(now_ms), out));
  }
  const double newest_ms = 1000.0 + 1000.0 / kHz * 119;
  EXPECT_NEAR(static_cast<double>(out.capture_time.since_zero_ns()) * 1e-6, newest_ms - 20.0, 0.01);
}

TEST(Hold, RefusesWhatIsNotNewerAndCountsIt) {
  Hold hold(Duration::ms(0));
  hold.observe(pose_of(at_ms(100)), at_ms(101));
  hold.observe(pose_of(at_ms(100)), at_ms(102));
  hold.observe(pose_of(at_ms(90)), at_ms(103));
  EXPECT_EQ(hold.counters().refused, 2u);
  EXPECT_EQ(hold.counters().restarts, 0u);
}

TEST(Hold, StartsAnewWhenTheSourceJumpsBackOrChangesItsClock) {
  Hold hold(Duration::ms(0));
  hold.observe(pose_of(at_ms(60'000)), at_ms(60'001));
  hold.observe(pose_of(at_ms(100)), at_ms(60'010));  // a replay that looped
  Pose out;
  ASSERT_TRUE(hold.sample(at_ms(60'010), out));
  EXPECT_EQ(out.capture_time, at_ms(100));
  hold.observe(pose_of(at_ms(7), 2), at_ms(60'020));  // another machine
  ASSERT_TRUE(hold.sample(at_ms(60'020), out));
  EXPECT_EQ(out.capture_time, at_ms(7));
  EXPECT_EQ(hold.counters().restarts, 2u);
}

TEST(Hold, NeverRunsBackwardsAndNeverFasterThanItsSlewWhileTheLineChanges) {
  Hold hold(Duration::ms(20));
  double transit_ms = 80.0;
  MonoTime shown;
  double last_sample_ms = 0.0;
  for (int i = 0; i < 1800; ++i) {
    if (i == 600) transit_ms = 30.0;    // a better route
    if (i == 1200) transit_ms = 120.0;  // a worse one
    const double capture_ms = 1000.0 / kHz * i;
    hold.observe(pose_of(at_ms(capture_ms)), at_ms(capture_ms + transit_ms));
    Pose out;
    const double now_ms = std::max(last_sample_ms, capture_ms + transit_ms);
    ASSERT_TRUE(hold.sample(at_ms(now_ms), out));
    EXPECT_GE(out.capture_time, shown) << i;
    shown = out.capture_time;
    last_sample_ms = now_ms;
  }
}

// Dances over a line whose transit is said pose by pose, negative for a lost one; the age shown and
// the part of the last half of the samples that had to repeat a pose.
struct Danced {
  double age_ms = 0.0;
  double starved = 0.0;
};
Danced dance_over(Hold& hold, int poses, const std::function<double(int)>& transit_ms) {
  double next_sample_ms = 0.0, last_arrival_ms = 0.0;
  std::uint64_t samples = 0, starved_before = 0;
  MonoTime shown;
  Danced danced;
  for (int i = 0; i < poses; ++i) {
    const double way_ms = transit_ms(i);
    if (way_ms < 0.0) continue;
    const double capture_ms = 1000.0 / kHz * i;
    const double arrival_ms = std::max(last_arrival_ms, capture_ms + way_ms);
    last_arrival_ms = arrival_ms;
    for (; next_sample_ms < arrival_ms; next_sample_ms += 1000.0 / kHz) {
      Pose out;
      const bool is_late_half = i > poses / 2;
      if (!is_late_half) starved_before = hold.counters().starved;
      const bool is_shown = hold.sample(at_ms(next_sample_ms), out);
      EXPECT_TRUE(!is_shown || out.capture_time >= shown) << "the dance goes back at pose " << i;
      shown = out.capture_time;
      if (!is_shown || !is_late_half) continue;
      ++samples;
      danced.age_ms +=
          next_sample_ms - static_cast<double>(out.capture_time.since_zero_ns()) * 1e-6;
    }
    hold.observe(pose_of(at_ms(capture_ms)), at_ms(arrival_ms));
  }
  danced.age_ms /= static_cast<double>(samples);
  danced.starved =
      static_cast<double>(hold.counters().starved - starved_before) / static_cast<double>(samples);
  return danced;
}

TEST(Hold, WithoutAWindowWaitsNoLongerThanACalmLineNeeds) {
  Hold hold;
  const Danced danced = dance_over(hold, 1800, [](int) { return 40.0; });
  EXPECT_NEAR(danced.age_ms, 40.0 + 1000.0 / kHz, 1.0) << "the way, and the wait for the next pose";
  EXPECT_EQ(danced.starved, 0.0);
}

TEST(Hold, WithoutAWindowWaitsAsLongAsATremblingLineNeeds) {
  Random random(3);
  Hold hold, fixed(Duration::ms(20));
  std::vector<double> ways;
  for (int i = 0; i < 3600; ++i)
    ways.push_back(random.uniform() < 0.1 ? -1.0 : 40.0 + 30.0 * random.uniform());
  const auto way = [&](int i) { return ways[static_cast<std::size_t>(i)]; };
  const Danced danced = dance_over(hold, 3600, way);
  EXPECT_LT(danced.starved, 0.02);
  EXPECT_LT(danced.age_ms, 40.0 + 30.0 + 4 * 1000.0 / kHz);
  EXPECT_GT(dance_over(fixed, 3600, way).starved, 0.2);
}

TEST(Hold, WithoutAWindowComesBackWhenTheLineIsCalmAgain) {
  Random random(4);
  Hold hold;
  const Danced danced = dance_over(
      hold, 4800, [&](int i) { return i < 1200 ? 40.0 + 80.0 * random.uniform() : 40.0; });
  EXPECT_NEAR(danced.age_ms, 40.0 + 1000.0 / kHz, 1.0);
}

TEST(Hold, WithoutAWindowNeverWaitsLongerThanItsBound) {
  Random random(5);
  Hold hold;
  const Danced danced = dance_over(
      hold, 3600, [&](int i) { return i % 256 < 128 ? 40.0 : 40.0 + 900.0 * random.uniform(); });
  EXPECT_LT(danced.age_ms, 40.0 + 900.0);
  EXPECT_LE(hold.delay(), Duration::ms(40 + 250 + 1));
}

TEST(Hold, StandsStillInsteadOfGoingBackWhenTheWayGetsMuchLonger) {
  for (const auto window : {std::optional<Duration>(), std::optional(Duration::ms(60))}) {
    Hold hold(window);
    // Known as the least delay some seconds later, and then more than it slews to.
    const Danced danced = dance_over(hold, 3600, [](int i) { return i < 600 ? 40.0 : 900.0; });
    EXPECT_GT(danced.age_ms, 900.0);
    EXPECT_LT(danced.age_ms, 900.0 + 61.0);
    EXPECT_EQ(danced.starved, 0.0);
  }
}

TEST(Hold, AllocatesNothingOncePosesCome) {
  Hold hold(Duration::ms(20));
  Pose out;
  AllocationGuard guard;
  for (int i = 0; i < 1000; ++i) {
    hold.observe(pose_of(at_ms(16.0 * i)), at_ms(16.0 * i + 5));
    hold.sample(at_ms(16.0 * i + 6), out);
  }
  EXPECT_EQ(guard.allocations(), 0u);
}

// 30 poses a second over a line that is not waited for: every picture is of what just came.
TEST(Hold, WhatItHasShownIsNotAnotherWhenTheNextPoseComes) {
  const auto pose_at = [](int i) {
    Pose pose;
    pose.capture_time = MonoTime::from_us(1'000'000 + i * 33'333);
    pose.clock_id = 1;
    pose.p_WH_m.x() = 0.3f * std::sin(0.4f * static_cast<float>(i));
    return pose;
  };
  DancerTimeline timeline(64);
  MotionSource::Parts parts;
  parts.is_final = true;
  MotionSource source(timeline, std::move(parts));
  std::vector<Pose> shown;
  for (int i = 0; i < 60; ++i) {
    timeline.take(pose_at(i), pose_at(i).capture_time);
    for (const Pose& before : shown) {
      Pose then;
      source.at(before.capture_time, then);
      EXPECT_EQ(then.p_WH_m.x(), before.p_WH_m.x()) << i;
    }
    shown.clear();
    if (i < 4) continue;
    for (const int back_ms : {4, 12, 20, 30, 50}) {
      shown.emplace_back();
      source.at(pose_at(i).capture_time - Duration::ms(back_ms), shown.back());
    }
  }
}

}  // namespace
}  // namespace dance
