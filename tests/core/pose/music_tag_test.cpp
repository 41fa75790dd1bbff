#include "core/pose/music_tag.h"

#include <gtest/gtest.h>

#include "tests/allocation_guard.h"

namespace dance {
namespace {

constexpr std::uint64_t kOurClock = 77;

MonoTime tag_second(double s) { return MonoTime() + Duration::seconds(s); }

Beat beat_at(double s, double beat) {
  Beat heard;
  heard.time = tag_second(s - 0.1);
  heard.clock_id = kOurClock;
  heard.beat_time = tag_second(s);
  heard.beat = beat;
  heard.tempo_bpm = 120.0;
  heard.beats_per_bar = 4;
  heard.confidence = 1.0f;
  heard.playing = true;
  return heard;
}

Pose pose_at(double s) {
  Pose pose;
  pose.clock_id = kOurClock;
  pose.capture_time = tag_second(s);
  return pose;
}

double tagged(const MusicTag& tag, Pose pose) {
  tag.tag(pose);
  return pose.music_beats;
}

TEST(MusicTag, SaysWhereTheMusicStoodAtTheCapture) {
  MusicTag tag(kOurClock);
  EXPECT_TRUE(std::isnan(tagged(tag, pose_at(10.0)))) << "no music yet";
  tag.hear(beat_at(10.0, 64.0));
  EXPECT_DOUBLE_EQ(tagged(tag, pose_at(10.0)), 64.0);
  EXPECT_DOUBLE_EQ(tagged(tag, pose_at(10.25)), 64.5);
  EXPECT_DOUBLE_EQ(tagged(tag, pose_at(9.95)), 63.9) << "captured before it was heard of";
}

TEST(MusicTag, LeavesWhatIsTaggedAndWhatIsOfAnotherClock) {
  MusicTag tag(kOurClock);
  tag.hear(beat_at(10.0, 64.0));
  Pose pose = pose_at(10.0);
  pose.music_beats = -3.5;
  EXPECT_EQ(tagged(tag, pose), -3.5);
  pose = pose_at(10.0);
  pose.clock_id = kOurClock + 1;
  EXPECT_TRUE(std::isnan(tagged(tag, pose)));
}

TEST(MusicTag, ABeatOfAnotherClockSaysNothing) {
  MusicTag tag(kOurClock);
  Beat foreign = beat_at(10.0, 64.0);
  foreign.clock_id = kOurClock + 1;
  tag.hear(foreign);
  EXPECT_TRUE(std::isnan(tagged(tag, pose_at(10.0))));
}

TEST(MusicTag, MusicThatStandsOrHasGoneGivesNoTime) {
  MusicTag tag(kOurClock);
  tag.hear(beat_at(10.0, 64.0));
  EXPECT_TRUE(std::isnan(tagged(tag, pose_at(13.5)))) << "nobody has said a beat for seconds";
  Beat stopped = beat_at(10.5, 65.0);
  stopped.playing = false;
  tag.hear(stopped);
  EXPECT_TRUE(std::isnan(tagged(tag, pose_at(10.6))));
}

TEST(MusicTag, AllocatesNothing) {
  MusicTag tag(kOurClock);
  Pose pose = pose_at(10.1);
  const AllocationGuard guard;
  tag.hear(beat_at(10.0, 64.0));
  tag.tag(pose);
  EXPECT_EQ(guard.allocations(), 0u);
}

}  // namespace
}  // namespace dance
