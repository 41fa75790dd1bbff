#include "producers/music/sound/play_plan.h"

#include <gtest/gtest.h>

#include <vector>

#include "core/base/random.h"
#include "producers/music/sound/volume_ramp.h"

namespace dance {
namespace {

constexpr double kTakenRate_hz = 48000.0;

MonoTime plan_time(double s) { return MonoTime() + Duration::seconds(s); }

TEST(StreamClock, AveragesWhatTrembles) {
  StreamClock clock(kTakenRate_hz);
  Random random(3);
  EXPECT_FALSE(clock.is_known());
  for (int i = 0; i < 200; ++i) {
    const double s = 100.0 + 0.1 * i;
    clock.report(plan_time(s), (s - 99.0 + 0.004 * (random.uniform() - 0.5)) * kTakenRate_hz);
  }
  ASSERT_TRUE(clock.is_known());
  EXPECT_NEAR(clock.frame_at(plan_time(130.0)) / kTakenRate_hz, 31.0, 0.001);
  EXPECT_NEAR((clock.time_of(31.0 * kTakenRate_hz) - plan_time(130.0)).as_seconds(), 0.0, 0.001);
}

TEST(StreamClock, FollowsACardThatDrifts) {
  StreamClock clock(kTakenRate_hz);
  constexpr double kDrift = 200e-6;  // ten times what cards have
  for (int i = 0; i < 600; ++i) {
    const double s = 0.1 * i;
    clock.report(plan_time(s), s * (1.0 + kDrift) * kTakenRate_hz);
  }
  EXPECT_NEAR(clock.frame_at(plan_time(60.0)) / kTakenRate_hz, 60.0 * (1.0 + kDrift), 0.0005);
}

TEST(StreamClock, BelievesAGapWhenItStays) {
  StreamClock clock(kTakenRate_hz);
  for (int i = 0; i < 30; ++i) clock.report(plan_time(0.1 * i), 0.1 * i * kTakenRate_hz);
  clock.report(plan_time(3.0), 2.0 * kTakenRate_hz);
  EXPECT_NEAR(clock.frame_at(plan_time(3.0)) / kTakenRate_hz, 3.0, 1e-6) << "one is a lie";
  clock.report(plan_time(3.1), 2.1 * kTakenRate_hz);
  clock.report(plan_time(3.2), 2.2 * kTakenRate_hz);
  EXPECT_EQ(clock.jumps(), 1u);
  clock.report(plan_time(3.3), 2.3 * kTakenRate_hz);
  clock.report(plan_time(3.4), 2.4 * kTakenRate_hz);
  ASSERT_TRUE(clock.is_known());
  EXPECT_NEAR(clock.frame_at(plan_time(3.4)) / kTakenRate_hz, 2.4, 1e-6);
}

// A sound card: plays frames at its own rate from a moment on, and says so.
struct Card {
  double begin_s;
  double drift;
  double frame_at(double s) const { return (s - begin_s) * (1.0 + drift) * kTakenRate_hz; }
};

TEST(PlayPlan, PutsTheSongWhereItIsHeardInTime) {
  const Card card{10.0, 0.0};
  StreamClock clock(kTakenRate_hz);
  for (int i = 0; i < 5; ++i)
    clock.report(plan_time(10.5 + 0.1 * i), card.frame_at(10.5 + 0.1 * i));
  PlayPlan plan(kTakenRate_hz);
  EXPECT_FALSE(plan.heard_s(clock, plan_time(11.0)));
  const MonoTime begin = plan_time(12.0);
  plan.align(clock, begin, 57600);
  EXPECT_EQ(plan.song_frame(96000), 0) << "what is heard at 12 s is the song's begin";
  EXPECT_NEAR(plan.heard_s(clock, plan_time(13.5)).value(), 1.5, 1e-4);
  EXPECT_NEAR(plan.error_s(clock, begin, plan_time(13.5)), 0.0, 1e-4);
}

TEST(PlayPlan, AJumpIsHeardWhereItWasWritten) {
  const Card card{0.0, 0.0};
  StreamClock clock(kTakenRate_hz);
  for (int i = 0; i < 5; ++i) clock.report(plan_time(0.1 * i), card.frame_at(0.1 * i));
  PlayPlan plan(kTakenRate_hz);
  plan.align(clock, plan_time(0.0), 0);
  plan.align(clock, plan_time(-10.0), 96000);  // another place, from second 2 on
  EXPECT_NEAR(plan.heard_s(clock, plan_time(1.9)).value(), 1.9, 1e-6);
  EXPECT_NEAR(plan.heard_s(clock, plan_time(2.1)).value(), 12.1, 1e-6);
}

TEST(PlayPlan, KeepsTheSongOnItsTimeThoughTheCardDrifts) {
  for (const double drift : {300e-6, -300e-6, 20e-6}) {
    StreamClock clock(kTakenRate_hz);
    PlayPlan plan(kTakenRate_hz);
    Random random(5);
    const MonoTime begin = plan_time(1.0);
    double speed = 1.0;
    double frame = 0.0;
    double worst_s = 0.0;
    for (int tick = 1; tick < 3000; ++tick) {
      const MonoTime now = plan_time(0.1 * tick);
      frame += 0.1 * kTakenRate_hz * speed * (1.0 + drift);
      clock.report(now, frame + 0.001 * (random.uniform() - 0.5) * kTakenRate_hz);
      if (!clock.is_known()) continue;
      if (!plan.is_aligned()) plan.align(clock, begin, static_cast<std::int64_t>(frame) + 9600);
      const double error_s = plan.error_s(clock, begin, now);
      ASSERT_FALSE(PlayPlan::wants_jump(error_s));
      if (tick > 600) worst_s = std::max(worst_s, std::abs(error_s));
      if (tick % 10 != 0) continue;
      // The server takes whole frames a second.
      speed = std::round(kTakenRate_hz * PlayPlan::speed_for(error_s)) / kTakenRate_hz;
      EXPECT_NEAR(speed, 1.0, 0.0021);
      clock.set_speed(speed, now);
    }
    EXPECT_LT(worst_s, 0.004) << drift;
  }
}

TEST(VolumeRamp, ChangesWithoutAStepAndArrives) {
  VolumeRamp ramp(1.0, kTakenRate_hz);
  std::vector<float> sound(2 * 4800, 1.0f);
  ramp.apply(sound);
  EXPECT_EQ(sound[0], 1.0f);
  EXPECT_EQ(sound.back(), 1.0f);
  ramp.set(0.25);
  std::fill(sound.begin(), sound.end(), 1.0f);
  ramp.apply(sound);
  float before = 1.0f;
  for (std::size_t i = 0; i < sound.size(); i += 2) {
    EXPECT_EQ(sound[i], sound[i + 1]) << "both sides";
    ASSERT_LE(before - sound[i], 1.001f / (VolumeRamp::kRamp_s * kTakenRate_hz)) << i;
    before = sound[i];
  }
  EXPECT_EQ(before, 0.25f);
  EXPECT_GT(sound[2 * 400], 0.25f) << "not at once";
}

}  // namespace
}  // namespace dance
