#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/base/beat_clock.h"
#include "core/base/random.h"
#include "tests/transformers/flows.h"
#include "transformers/playout/play_head.h"
#include "transformers/predict/blend/prediction_meter.h"
#include "transformers/rhythm/beat_offset.h"
#include "transformers/rhythm/dancer_music.h"

namespace dance {
namespace {

MonoTime second(double s) { return MonoTime::from_us(1'000'000) + Duration::seconds(s); }

Beat beat_at(double s, double beats_per_second, double beats) {
  Beat beat;
  beat.time = second(s);
  beat.beat_time = second(s);
  beat.beat = beats;
  beat.tempo_bpm = 60.0 * beats_per_second;
  beat.confidence = 1.0f;
  beat.playing = true;
  return beat;
}

TEST(BeatClock, RunsOnBetweenBeatsAndBack) {
  BeatClock clock;
  EXPECT_FALSE(clock.is_known(second(0)));
  EXPECT_TRUE(clock.hear(beat_at(0.0, 2.0, 10.0)));
  EXPECT_DOUBLE_EQ(clock.position(second(1.25)), 12.5);
  EXPECT_EQ(clock.time_of(12.5), second(1.25));
  EXPECT_TRUE(clock.is_known(second(2.9)));
  EXPECT_FALSE(clock.is_known(second(3.1)));
}

TEST(BeatClock, TakesASmallCorrectionInWithoutAJumpOrAStandstill) {
  BeatClock clock;
  clock.hear(beat_at(0.0, 50.0 / 60.0, 0.0));
  const double before = clock.position(second(1.0));
  EXPECT_FALSE(clock.hear(beat_at(1.0, 50.0 / 60.0, before - 0.2)));
  EXPECT_NEAR(clock.position(second(1.0)), before, 1e-9);
  for (double s = 1.0; s < 3.0; s += 0.01)
    EXPECT_GT(clock.position(second(s + 0.01)), clock.position(second(s)));
  EXPECT_NEAR(clock.position(second(3.0)), before - 0.2 + 2.0 * 50.0 / 60.0, 1e-3);
  // And the way back agrees while it is being taken in.
  EXPECT_NEAR(clock.position(clock.time_of(1.0)), 1.0, 1e-5);
}

TEST(BeatClock, SaysThatTheMusicJumpedOrStands) {
  BeatClock clock;
  clock.hear(beat_at(0.0, 2.0, 0.0));
  EXPECT_TRUE(clock.hear(beat_at(1.0, 2.0, 40.0)));
  EXPECT_DOUBLE_EQ(clock.position(second(1.0)), 40.0);
  Beat still = beat_at(2.0, 2.0, 42.0);
  still.playing = false;
  clock.hear(still);
  EXPECT_FALSE(clock.is_known(second(2.0)));
}

TEST(BeatClock, DoesNotBelieveWhatIsSaidInTheFuture) {
  BeatClock clock;
  clock.hear(beat_at(1e6, 2.0, 0.0));
  EXPECT_FALSE(clock.is_known(second(0.0)));
  EXPECT_TRUE(clock.is_known(second(1e6 + 1.0)));
}

TEST(DancerMusic, FindsMomentsOfBeatsAndBeatsOfMoments) {
  DancerMusic line;
  EXPECT_FALSE(line.is_known(second(0)));
  for (int i = 0; i <= 300; ++i) line.add(second(i / 60.0), 7.0 + 2.5 * i / 60.0);
  ASSERT_TRUE(line.is_known(second(5.0)));
  EXPECT_NEAR(line.beats_per_second(), 2.5, 1e-9);
  for (const double s : {-1.0, 0.0, 1.234, 4.999, 5.0, 6.5}) {
    EXPECT_NEAR(line.position(second(s)), 7.0 + 2.5 * s, 1e-6) << s;
    EXPECT_NEAR((line.time_of(7.0 + 2.5 * s) - second(s)).as_seconds(), 0.0, 1e-6) << s;
  }
  EXPECT_FALSE(line.is_known(second(16.0)));
}

TEST(DancerMusic, FollowsATempoThatDrifts) {
  DancerMusic line;
  double beats = 0.0;
  for (int i = 0; i < 1200; ++i) {
    const double s = i / 60.0;
    beats += (2.7 + 0.15 * std::sin(s / 3.0)) / 60.0;
    line.add(second(s), beats);
    if (i < 120) continue;
    const double ahead = beats + (2.7 + 0.15 * std::sin(s / 3.0)) * 0.2;
    EXPECT_NEAR(line.position(second(s + 0.2)), ahead, 0.02);
  }
}

TEST(DancerMusic, BeginsAnewWhereTheMusicJumps) {
  DancerMusic line;
  for (int i = 0; i < 120; ++i) EXPECT_FALSE(line.add(second(i / 60.0), 2.0 * i / 60.0));
  EXPECT_FALSE(line.add(second(1.0), 99.0)) << "not newer: passed over";
  EXPECT_TRUE(line.add(second(2.0), 99.0));
  EXPECT_FALSE(line.is_known(second(2.0)));
  for (int i = 1; i < 60; ++i)
    EXPECT_FALSE(line.add(second(2.0 + i / 60.0), 99.0 + 2.0 * i / 60.0));
  EXPECT_NEAR(line.position(second(2.5)), 100.0, 1e-6);
  EXPECT_TRUE(line.add(second(3.0), 50.0)) << "backwards";
}

TEST(PlayHead, StandsOnTheWantedMomentAndGoesNoFasterThanABody) {
  PlayHead head;
  double s = 0.0;
  EXPECT_EQ(head.advance(second(0.0), second(-0.4), 1.0), second(-0.4));
  // The wanted moment goes on at 1.02 of the pace, and the head with it.
  for (; s < 4.0; s += 1.0 / 60.0) head.advance(second(s), second(-0.4 + 1.02 * s), 1.02);
  const double last = s - 1.0 / 60.0;
  EXPECT_NEAR((head.moment() - second(-0.4 + 1.02 * last)).as_ms(), 0.0, 0.1);
  // A jump of the wanted moment by 0.2 s is walked, with rates that a body can do.
  MonoTime before = head.moment();
  double rate_before = head.rate();
  for (; s < 8.0; s += 1.0 / 60.0) {
    const MonoTime now_at = head.advance(second(s), second(-0.2 + 1.02 * s), 1.02);
    const double rate = (now_at - before).as_seconds() * 60.0;
    EXPECT_GE(rate, kSlowestPlay - 1e-6);
    EXPECT_LE(rate, kFastestPlay + 1e-6);
    EXPECT_LE(std::abs(head.rate() - rate_before), 6.0 / 60.0 + 1e-6);
    rate_before = head.rate();
    before = now_at;
  }
  EXPECT_NEAR((head.moment() - second(-0.2 + 1.02 * (s - 1.0 / 60.0))).as_ms(), 0.0, 2.0);
}

TEST(PlayHead, BeginsAnewAfterAStandstill) {
  PlayHead head;
  head.advance(second(0.0), second(0.0), 1.0);
  EXPECT_EQ(head.advance(second(5.0), second(3.0), 1.0), second(3.0));
  EXPECT_EQ(head.advance(second(4.0), second(2.0), 1.0), second(2.0)) << "time that goes back";
}

BeatOffset::Wish wish(double beats, double least = -0.25) {
  BeatOffset::Wish wish;
  wish.beats = beats;
  wish.least_beats = least;
  wish.easy_beats = least + 0.3;
  return wish;
}

TEST(BeatOffset, KeepsTheWishedDelayOverWholeBeats) {
  for (const double beats : {0.0, 1.0, 2.0, 4.0})
    for (const double difference : {-3.3, 0.0, 0.2, 17.4}) {
      BeatOffset offset;
      EXPECT_TRUE(offset.update(wish(beats), difference, second(0)));
      EXPECT_DOUBLE_EQ(offset.value(), std::round(offset.value()));
      EXPECT_NEAR(offset.value() - difference, beats, 0.75);
      EXPECT_GE(offset.value() - difference, -0.25);
    }
}

TEST(BeatOffset, ChangesSeldomWhileTheMusicsDrift) {
  BeatOffset offset;
  int changes = 0;
  // One per cent at 160 BPM for two minutes: 3.2 beats.
  for (double s = 0.0; s < 120.0; s += 0.02)
    changes += offset.update(wish(1.0), 0.01 * s * 160.0 / 60.0, second(s)) ? 1 : 0;
  EXPECT_LE(changes, 4);
  EXPECT_NEAR(offset.value() - 3.2, 1.0, 1.0);
}

TEST(BeatOffset, TakesMoreDelayWhereTheLineNeedsItAndGivesItBackLater) {
  BeatOffset offset;
  offset.update(wish(-1.0, 0.2), 0.0, second(0));
  EXPECT_DOUBLE_EQ(offset.value(), 1.0);
  // Prediction has become good enough for nothing but itself.
  double s = 0.0;
  for (; s < 3.9; s += 0.02) EXPECT_FALSE(offset.update(wish(-1.0, -0.4), 0.0, second(s)));
  for (; s < 5.0; s += 0.02) offset.update(wish(-1.0, -0.4), 0.0, second(s));
  EXPECT_DOUBLE_EQ(offset.value(), 0.0);
  // And the line worse again: not at once, but soon.
  EXPECT_FALSE(offset.update(wish(-1.0, 0.5), 0.0, second(5.0)));
  EXPECT_FALSE(offset.update(wish(-1.0, 0.5), 0.0, second(5.1)));
  EXPECT_TRUE(offset.update(wish(-1.0, 0.5), 0.0, second(5.2)));
  EXPECT_DOUBLE_EQ(offset.value(), 1.0);
}

TEST(BeatOffset, WaitsForAMomentWhenTheJumpIsSmall) {
  BeatOffset offset;
  offset.update(wish(-1.0, 0.2), 0.0, second(0));
  // The dance is like itself a beat later for a moment only.
  const auto jump_at = [](double s) {
    return [s](double) { return s > 6.0 && s < 6.1 ? 0.04 : 0.6; };
  };
  double s = 0.0;
  for (; s < 6.0; s += 0.02)
    EXPECT_FALSE(offset.update(wish(-1.0, -0.4), 0.0, second(s), jump_at(s))) << s;
  for (; s < 6.1; s += 0.02) offset.update(wish(-1.0, -0.4), 0.0, second(s), jump_at(s));
  EXPECT_DOUBLE_EQ(offset.value(), 0.0);
}

TEST(BeatOffset, WaitsForASmallJumpNoLongerThanItMust) {
  const auto far = [](double) { return 10.0; };
  BeatOffset offset;
  offset.update(wish(-1.0, 0.2), 0.0, second(0));
  double s = 0.0;
  for (; offset.value() > 0.5 && s < 60.0; s += 0.02)
    offset.update(wish(-1.0, -0.4), 0.0, second(s), far);
  EXPECT_NEAR(s, 12.0, 0.1);
  // More delay is needed sooner.
  const double since = s;
  for (; offset.value() < 0.5 && s < 60.0; s += 0.02)
    offset.update(wish(-1.0, 0.5), 0.0, second(s), far);
  EXPECT_NEAR(s - since, 1.15, 0.1);
}

TEST(BeatOffset, BearsALittleMoreThanItBeganWith) {
  BeatOffset offset;
  BeatOffset::Wish line = wish(-1.0, -0.01);
  line.slack_beats = 0.1;
  offset.update(line, 0.0, second(0));
  EXPECT_DOUBLE_EQ(offset.value(), 0.0);
  line.least_beats = 0.09;
  for (double s = 0.0; s < 60.0; s += 0.02) EXPECT_FALSE(offset.update(line, 0.0, second(s)));
}

TEST(BeatOffset, ComesDownNoFurtherThanIsEasy) {
  BeatOffset offset;
  offset.update(wish(-1.0, 2.5), 0.0, second(0));
  EXPECT_DOUBLE_EQ(offset.value(), 3.0);
  BeatOffset::Wish line = wish(-1.0, -0.1);  // easy from 0.2 on
  line.slack_beats = 0.2;
  for (double s = 0.0; s < 30.0; s += 0.02) offset.update(line, 0.0, second(s));
  EXPECT_DOUBLE_EQ(offset.value(), 1.0);
}

TEST(BeatOffset, ComesDownLaterWhereThatNeverLasts) {
  // Half a second of every twenty the line is worse by half a beat.
  const auto changes_in = [](double from_s, double to_s) {
    BeatOffset offset;
    int changes = 0;
    for (double s = 0.0; s < to_s; s += 0.02) {
      const bool is_bad = std::fmod(s, 20.0) > 19.5;
      const bool changed = offset.update(wish(-1.0, is_bad ? 0.4 : -0.4), 0.0, second(s));
      changes += changed && s >= from_s ? 1 : 0;
    }
    return changes;
  };
  EXPECT_GE(changes_in(0.0, 60.0), 4) << "at first it is worth a try";
  EXPECT_EQ(changes_in(120.0, 1200.0), 0);
}

TEST(BeatOffset, ComesBackToTheWishAfterABadMinute) {
  BeatOffset offset;
  offset.update(wish(1.0, 0.5), 0.0, second(0));
  EXPECT_DOUBLE_EQ(offset.value(), 1.0);
  double s = 0.0;
  for (; s < 60.0; s += 0.02) offset.update(wish(1.0, 1.3), 0.0, second(s));
  EXPECT_DOUBLE_EQ(offset.value(), 2.0);
  for (; s < 63.9; s += 0.02) EXPECT_FALSE(offset.update(wish(1.0, 0.5), 0.0, second(s)));
  for (; s < 65.0; s += 0.02) offset.update(wish(1.0, 0.5), 0.0, second(s));
  EXPECT_DOUBLE_EQ(offset.value(), 1.0);
}

TEST(BeatOffset, BearsAsMuchAsItIsToldBeforeItGrows) {
  for (const double slack : {0.0, 0.1}) {
    BeatOffset offset;
    BeatOffset::Wish line = wish(1.0, 0.5);
    line.slack_beats = slack;
    double s = 0.0;
    // The listener's music runs ahead, and what is left of the beat grows less.
    double difference = 0.0;
    for (; offset.value() < 2.0 && s < 60.0; s += 0.02) {
      difference = 0.02 * s;
      offset.update(line, difference, second(s));
    }
    EXPECT_NEAR(1.0 - difference, 0.5 - slack, 0.01);
  }
}

TEST(BeatOffset, KeepsTheBarWhereAskedTo) {
  BeatOffset offset;
  BeatOffset::Wish bars = wish(1.0, 0.3);
  bars.count = 4.0;
  offset.update(bars, 0.1, second(0));
  EXPECT_DOUBLE_EQ(std::fmod(offset.value(), 4.0), 0.0);
  EXPECT_GE(offset.value(), 0.4);
}

// One arm that swings once in four beats of 0.8 s.
constexpr double kSwing_rad_s = 2.0 * std::numbers::pi / 3.2;
constexpr Duration kSwingBeat = Duration::ms(800);

double swing_rad(double s) { return 0.8 * std::sin(kSwing_rad_s * s); }

Pose swing(double s, double angle_rad) {
  Pose pose;
  pose.capture_time = second(s);
  pose.clock_id = 1;
  pose.R_PB[index_of(Bone::kLeftUpperArm)] = Eigen::Quaternionf(
      Eigen::AngleAxisf(static_cast<float>(angle_rad), Eigen::Vector3f::UnitZ()));
  return pose;
}

// What predictions are worth that go `share` of the way: those of none repeat the newest pose,
// those of all know the dance.
PredictionMeter measured(double share, Duration beat = kSwingBeat) {
  PredictionMeter meter;
  PoseHistory history(512);
  for (int i = 0; i < 3600; ++i) {
    const double s = i / 60.0;
    history.push(swing(s, swing_rad(s)));
    meter.learn(history, beat);
    if (i % 2 != 0) continue;
    const double then = s + meter.next_horizon().as_seconds();
    const double angle = swing_rad(s) + share * (swing_rad(then) - swing_rad(s));
    meter.note(swing(s, swing_rad(s)), swing(then, angle), second(then));
  }
  return meter;
}

TEST(PredictionMeter, KnowsHowGoodPredictionsAre) {
  EXPECT_FALSE(PredictionMeter().is_known());
  const PredictionMeter good = measured(1.0), bad = measured(0.0);
  ASSERT_TRUE(good.is_known());
  EXPECT_LT(good.error_m(Duration::ms(300)), 0.1 * bad.error_m(Duration::ms(300)));
  EXPECT_GE(good.reach(0.02), Duration::ms(400));
  EXPECT_GT(bad.error_m(Duration::ms(300)), 2.0 * bad.error_m(Duration::ms(100)));
  const Duration reach = bad.reach(bad.error_m(Duration::ms(150)));
  EXPECT_NEAR(reach.as_ms(), 150.0, 1.0);
}

TEST(PredictionMeter, LengthensWaysByWhatIsMissingOfThem) {
  for (std::size_t h = 0; h < PredictionLead::kHorizons.size(); ++h) {
    EXPECT_NEAR(measured(1.0).gain(h), 1.0f, 0.05f) << h;
    EXPECT_NEAR(measured(0.8).gain(h), 1.25f, 0.05f) << h;
    EXPECT_EQ(PredictionMeter().gain(h), PredictionLead::usual_gain(h)) << "nothing is known";
    EXPECT_EQ(measured(0.8, Duration()).gain(h), PredictionLead::usual_gain(h)) << "no music";
    EXPECT_LE(measured(0.2).gain(h), 1.7f) << "bounded";
  }
}

// 30 poses a second; pictures between the newest two, whose way is not known before the next one
// comes.
TEST(Rhythm, WhatTheNextPoseChangesOfWhatWasShownGoesInWithoutAPop) {
  // Shows the moments of its poses at once.
  class Now : public PlayoutClock {
   public:
    void observe(const DancerTimeline&, MotionSource&) override {}
    void restart() override {}
    Choice choose(const DancerTimeline&, MonoTime now, MonoTime) override {
      return {now - Duration::ms(1), {}, false};
    }
  };
  Rhythm rhythm({}, std::make_unique<Now>());
  // Turns back at every other pose: the curve changes as much as it can.
  const auto observe = [&](int i) {
    Pose pose;
    pose.capture_time = second(i / 30.0);
    pose.clock_id = 1;
    pose.p_WH_m.x() = i / 2 % 2 ? 0.05f : 0.0f;
    rhythm.observe(pose, pose.capture_time);
  };
  float largest_m = 0.0f;
  for (int i = 0; i < 90; ++i) {
    observe(i);
    Pose before, after;
    const MonoTime now = second(i / 30.0);
    // 17 ms before the newest pose, and again as soon as the next has come.
    ASSERT_TRUE(rhythm.sample(now - Duration::ms(16), before));
    observe(++i);
    ASSERT_TRUE(rhythm.sample(now - Duration::ms(15), after));
    if (i > 10) largest_m = std::max(largest_m, (after.p_WH_m - before.p_WH_m).norm());
  }
  EXPECT_LT(largest_m, 0.003f);
}

}  // namespace
}  // namespace dance
