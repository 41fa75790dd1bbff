// Musical time is put on poses where captures enter, once.
#include "core/bus/captures.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "tests/core/bus/port_double.h"

namespace dance {
namespace {

constexpr std::uint64_t kOurClock = 77;
const GuestId kAlice = *GuestId::parse("alice");
const GuestId kBob = *GuestId::parse("bob");

Beat beat_at_ten_seconds() {
  Beat beat;
  beat.time = beat.beat_time = MonoTime() + Duration::s(10);
  beat.clock_id = kOurClock;
  beat.beat = 64.0;
  beat.tempo_bpm = 120.0;
  beat.playing = true;
  return beat;
}

Pose pose_at(double s) {
  Pose pose;
  pose.clock_id = kOurClock;
  pose.capture_time = MonoTime() + Duration::seconds(s);
  return pose;
}

TEST(Captures, OfAProducerGetMusicalTimeAndAStamp) {
  PortDouble port;
  Captures captures(port, kOurClock);
  Pose pose = pose_at(10.25);
  captures.publish(kAlice, pose, MonoTime::from_us(5));
  EXPECT_TRUE(std::isnan(pose.music_beats)) << "no music yet";
  port.publish(Channel::of_house(Signal::kBeat), beat_at_ten_seconds());
  captures.publish(kAlice, pose, MonoTime::from_us(6));
  Pose sent;
  ASSERT_EQ(decode(port.bytes.data(), port.size, sent), Decoded::kFine);
  EXPECT_EQ(sent.music_beats, 64.5);
  EXPECT_EQ(sent.stamped(Hop::kPublished), MonoTime::from_us(6));
  EXPECT_EQ(port.sent,
            (std::vector<std::string>{"POSE/capture/alice", "BEAT/local", "POSE/capture/alice"}));
  EXPECT_EQ(captures.music().position(pose.capture_time), 64.5);
}

TEST(Captures, OfProducersThatKnowNoMusicGetMusicalTimeWhereTheyAreHeard) {
  PortDouble port;
  Captures captures(port, kOurClock);
  std::vector<double> heard;
  captures.subscribe(kAlice, [&](const Channel& channel, const Pose& pose, MonoTime) {
    EXPECT_EQ(channel.guest(), kAlice);
    heard.push_back(pose.music_beats);
  });
  port.publish(Channel::of_house(Signal::kBeat), beat_at_ten_seconds());
  port.publish(Where::kCapture, kAlice, pose_at(10.5));
  port.publish(Where::kCapture, kBob, pose_at(10.5));
  port.publish(Where::kGuest, kAlice, pose_at(10.5));
  Pose pose = pose_at(10.5);
  pose.music_beats = 3.0;
  port.publish(Where::kCapture, kAlice, pose);  // keeps its own
  EXPECT_EQ(heard, (std::vector<double>{65.0, 3.0}));
}

}  // namespace
}  // namespace dance
