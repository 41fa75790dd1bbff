// Which part of a recording the timeline shows, and which marks it has room for.
#include "viewer/replay/timeline/timeline_scale.h"

#include <gtest/gtest.h>

namespace dance {
namespace {

MonoTime moment(double s) { return MonoTime() + Duration::seconds(100.0 + s); }

TimelineScale of_ten_seconds() {
  TimelineScale scale(moment(0.0), moment(10.0));
  scale.set_width(100.0f, 1100.0f);
  return scale;
}

TEST(TimelineScale, APlaceAndItsMomentBelongTogether) {
  const TimelineScale scale = of_ten_seconds();
  EXPECT_NEAR(scale.x_of(moment(2.5)), 350.0f, 0.01f);
  EXPECT_NEAR((scale.moment_at(350.0f) - moment(2.5)).as_seconds(), 0.0, 1e-4);
  EXPECT_NEAR(scale.pixels_per_second(), 100.0, 1e-3);
}

TEST(TimelineScale, WhatIsUnderTheWheelStaysThere) {
  TimelineScale scale = of_ten_seconds();
  const MonoTime under = scale.moment_at(700.0f);
  for (int i = 0; i < 5; ++i) {
    scale.zoom(1.0f, 700.0f);
    EXPECT_NEAR((scale.moment_at(700.0f) - under).as_seconds(), 0.0, 1e-3);
  }
  EXPECT_FALSE(scale.is_whole());
  EXPECT_GE(scale.from(), moment(0.0));
  EXPECT_LE(scale.to(), moment(10.0));
  for (int i = 0; i < 100; ++i) scale.zoom(1.0f, 700.0f);
  EXPECT_GE(scale.to() - scale.from(), TimelineScale::kShortest);
  for (int i = 0; i < 100; ++i) scale.zoom(-1.0f, 300.0f);
  EXPECT_TRUE(scale.is_whole());
}

TEST(TimelineScale, FollowsTheMomentThatIsPlayed) {
  TimelineScale scale = of_ten_seconds();
  for (int i = 0; i < 10; ++i) scale.zoom(1.0f, 100.0f);
  ASSERT_LT(scale.to(), moment(8.0));
  scale.follow(moment(9.0));
  EXPECT_LE(scale.from(), moment(9.0));
  EXPECT_GE(scale.to(), moment(9.0));
  scale.follow(moment(0.5));
  EXPECT_LE(scale.from(), moment(0.5));
}

TEST(TimelineScale, MarksAreThinnedOutUntilTheyHaveRoom) {
  std::vector<ReplayIndex::WholeBeat> beats;
  for (int beat = 0; beat <= 1000; ++beat)
    beats.push_back({static_cast<double>(beat), moment(0.01 * beat), 4});
  const TimelineScale scale = of_ten_seconds();
  const auto ticks = beat_ticks(beats, scale, 5.0f, 40.0f);
  ASSERT_GT(ticks.size(), 10u);
  float last = -1e9f, last_label = -1e9f;
  for (const BeatTick& tick : ticks) {
    const float x = scale.x_of(tick.time);
    EXPECT_GE(x - last, 4.99f);
    last = x;
    if (!tick.has_label) continue;
    EXPECT_GE(x - last_label, 39.9f);
    last_label = x;
  }
}

TEST(TimelineScale, SaysBarsBeatsAndTempo) {
  std::vector<ReplayIndex::WholeBeat> beats;
  for (int beat = 0; beat <= 16; ++beat)
    beats.push_back({static_cast<double>(beat), moment(0.5 * beat), 4});
  EXPECT_EQ(bar_text(beats, moment(2.6)), "bar 2, beat 2");
  EXPECT_NEAR(tempo_at(beats, moment(2.6)), 120.0, 0.1);
  EXPECT_EQ(bar_text({}, moment(2.6)), "");
  EXPECT_EQ(tempo_at({}, moment(2.6)), 0.0);
}

TEST(TimelineScale, WritesTimesAsFineAsTheirStepNeeds) {
  EXPECT_EQ(clock_text(65.0, 1.0), "1:05");
  EXPECT_EQ(clock_text(65.3, 0.1), "1:05.3");
  EXPECT_EQ(clock_text(3725.0, 60.0), "1:02:05");
}

}  // namespace
}  // namespace dance
