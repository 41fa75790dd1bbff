#include "transformers/timeline.h"

#include <gtest/gtest.h>

#include "tests/transformers/flows.h"

namespace dance {
namespace {

Pose captured_at(int ms, std::uint64_t clock_id = 1) {
  Pose pose;
  pose.capture_time = at_ms(ms);
  pose.clock_id = clock_id;
  return pose;
}

using Taken = DancerTimeline::Taken;

TEST(DancerTimeline, KnowsWhenItsNewestPoseCameAndHowLongItTook) {
  DancerTimeline timeline(8);
  EXPECT_TRUE(timeline.is_empty());
  EXPECT_EQ(timeline.take(captured_at(5000), at_ms(5040)), Taken::kTaken);
  EXPECT_EQ(timeline.gap(), Duration());
  EXPECT_EQ(timeline.take(captured_at(5017), at_ms(5050)), Taken::kTaken);
  EXPECT_EQ(timeline.arrived(), at_ms(5050));
  EXPECT_EQ(timeline.transit(), Duration::ms(33));
  EXPECT_EQ(timeline.gap(), Duration::ms(17));
  EXPECT_EQ(timeline.poses().size(), 2u);
}

TEST(DancerTimeline, RefusesWhatIsNotNewerAndKeepsWhatItHas) {
  DancerTimeline timeline(8);
  timeline.take(captured_at(5000), at_ms(5040));
  EXPECT_EQ(timeline.take(captured_at(5000), at_ms(5041)), Taken::kRefused);
  EXPECT_EQ(timeline.take(captured_at(4001), at_ms(5042)), Taken::kRefused);
  EXPECT_EQ(timeline.counters().refused, 2u);
  EXPECT_EQ(timeline.arrived(), at_ms(5040));
}

TEST(DancerTimeline, StartsAnewWithAJumpBackOrAnotherClock) {
  DancerTimeline timeline(8);
  timeline.take(captured_at(5000), at_ms(5040));
  EXPECT_EQ(timeline.take(captured_at(3999), at_ms(5041)), Taken::kRestarted);
  EXPECT_EQ(timeline.poses().size(), 1u);
  EXPECT_EQ(timeline.gap(), Duration());
  EXPECT_EQ(timeline.take(captured_at(9000, 2), at_ms(5042)), Taken::kRestarted);
  EXPECT_EQ(timeline.counters().restarts, 2u);
}

TEST(DancerTimeline, TakesBodiesAndBeatsThatAreNoneForNothing) {
  DancerTimeline timeline(8);
  Skeleton body = average_skeleton();
  body.offset_m[3].x() = std::nanf("");
  EXPECT_FALSE(timeline.set_body(body));
  EXPECT_TRUE(is_valid(timeline.body()));
  Beat beat;
  beat.time = beat.beat_time = at_ms(1000);
  beat.tempo_bpm = 1e9;
  beat.confidence = 1.0f;
  beat.playing = true;
  EXPECT_FALSE(timeline.hear(beat));
  EXPECT_FALSE(timeline.music().is_known(at_ms(1000)));
  beat.tempo_bpm = 120.0;
  EXPECT_TRUE(timeline.hear(beat)) << "the first is a jump";
  EXPECT_TRUE(timeline.music().is_known(at_ms(1000)));
}

}  // namespace
}  // namespace dance
