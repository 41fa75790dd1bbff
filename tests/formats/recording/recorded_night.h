// A recorded night for tests of file formats: two guests of different size who turn and travel,
// their hands, and the beats of the house.
//
// Ownership: plain values.
// Threads:   none.
// Failure:   none.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>

#include "core/pose/kinematics.h"
#include "formats/recording/recording.h"
#include "tests/core/pose/random_pose.h"

namespace dance {

constexpr std::int64_t kNight_us = 1'772'395'530'000'000;
constexpr std::uint64_t kNightClock = 0xf123456789abcdef;  // more than a double holds
const GuestId kAlice = GuestId::parse("alice").value();
const GuestId kBob = GuestId::parse("bob").value();

// Frame i of a guest at 60 Hz, with jitter.
inline Pose night_pose(Random& random, std::uint32_t i) {
  Pose pose = random_pose(random, 1.5f);
  pose.sequence = i + 1;
  pose.clock_id = kNightClock;
  pose.capture_time =
      MonoTime::from_us(50'000'000 + i * 16'667 + static_cast<std::int64_t>(random.below(2000)));
  pose.presence = kAllBones & ~(1u << (i % kBoneCount));
  if (i % 3 != 0) pose.music_beats = 12.0 + 0.05 * i;
  return pose;
}

inline Hands night_hands(Random& random, const Pose& pose) {
  Hands hands;
  for (auto& rotation : hands.R_PB) rotation = random_rotation(random, 1.0f);
  hands.sequence = pose.sequence;
  hands.clock_id = pose.clock_id;
  hands.capture_time = pose.capture_time;
  hands.presence = 0x3ffffffe;
  return hands;
}

inline Recording recorded_night(std::uint32_t frames) {
  Recording night;
  Random random(20'260'302);
  night.on_skeleton(kAlice, average_skeleton(1.58f), kNight_us);
  night.on_skeleton(kBob, average_skeleton(1.85f), kNight_us);
  for (std::uint32_t i = 0; i < frames; ++i) {
    const std::int64_t time_us = kNight_us + i * std::int64_t{16'667};
    for (const GuestId& guest : {kAlice, kBob}) {
      const Pose pose = night_pose(random, i);
      night.on_pose(guest, pose, time_us + 100);
      if (guest == kAlice) night.on_hands(guest, night_hands(random, pose), time_us + 110);
    }
    if (i % 15 != 0) continue;
    Beat beat;
    beat.time = MonoTime::from_us(50'000'000 + i * 16'667);
    beat.beat_time = beat.time + Duration::ms(200);
    beat.clock_id = kNightClock;
    beat.beat = 12.0 + i / 15;
    beat.tempo_bpm = 181.5;
    beat.beats_per_bar = 4;
    beat.confidence = 0.75f;
    beat.playing = true;
    night.on_beat(beat, time_us + 120);
  }
  return night;
}

// The largest distance between the same joints, ends of the body included.
inline float largest_distance_m(const Skeleton& skeleton, const Pose& pose,
                                const Skeleton& other_skeleton, const Pose& other) {
  BodyFrames a, b;
  forward_kinematics(skeleton, pose, a);
  forward_kinematics(other_skeleton, other, b);
  float largest = 0.0f;
  for (std::size_t i = 0; i < kBoneCount; ++i)
    largest = std::max(largest, (a.p_WB_m[i] - b.p_WB_m[i]).norm());
  for (std::size_t i = 0; i < kTipCount; ++i)
    largest = std::max(largest, (a.p_WT_m[i] - b.p_WT_m[i]).norm());
  return largest;
}

inline void expect_same_poses(const Recording& night, const Recording& read) {
  ASSERT_EQ(read.guests().size(), night.guests().size());
  for (const RecordedGuest& guest : night.guests()) {
    const RecordedGuest* same = read.find(guest.guest);
    ASSERT_NE(same, nullptr) << guest.guest.view();
    ASSERT_EQ(same->poses.size(), guest.poses.size());
    for (std::size_t i = 0; i < guest.poses.size(); ++i) {
      const Pose& pose = guest.poses[i].value;
      const Pose& other = same->poses[i].value;
      EXPECT_EQ(same->poses[i].time_us, guest.poses[i].time_us);
      EXPECT_EQ(other.capture_time, pose.capture_time);
      EXPECT_EQ(other.clock_id, pose.clock_id);
      EXPECT_EQ(other.sequence, pose.sequence);
      EXPECT_EQ(other.presence, pose.presence);
      EXPECT_EQ(other.confidence, pose.confidence);
      EXPECT_EQ(std::isnan(other.music_beats), std::isnan(pose.music_beats));
      if (!std::isnan(pose.music_beats)) {
        EXPECT_EQ(other.music_beats, pose.music_beats);
      }
      EXPECT_LT(largest_distance_m(guest.skeleton(), pose, same->skeleton(), other), 1e-4f);
    }
  }
}

inline void expect_same_hands_and_beats(const Recording& night, const Recording& read) {
  for (const RecordedGuest& guest : night.guests()) {
    const RecordedGuest* same = read.find(guest.guest);
    ASSERT_NE(same, nullptr);
    ASSERT_EQ(same->hands.size(), guest.hands.size());
    for (std::size_t i = 0; i < guest.hands.size(); ++i) {
      EXPECT_EQ(same->hands[i].value.capture_time, guest.hands[i].value.capture_time);
      EXPECT_EQ(same->hands[i].value.presence, guest.hands[i].value.presence);
      for (std::size_t b = 0; b < kFingerBoneCount; ++b)
        EXPECT_TRUE(is_same_rotation(same->hands[i].value.R_PB[b], guest.hands[i].value.R_PB[b]));
    }
  }
  ASSERT_EQ(read.beats().size(), night.beats().size());
  for (std::size_t i = 0; i < night.beats().size(); ++i) {
    const Beat& beat = night.beats()[i].value;
    const Beat& other = read.beats()[i].value;
    EXPECT_EQ(read.beats()[i].time_us, night.beats()[i].time_us);
    EXPECT_EQ(other.time, beat.time);
    EXPECT_EQ(other.beat_time, beat.beat_time);
    EXPECT_EQ(other.clock_id, beat.clock_id);
    EXPECT_EQ(other.beat, beat.beat);
    EXPECT_EQ(other.tempo_bpm, beat.tempo_bpm);
    EXPECT_EQ(other.beats_per_bar, beat.beats_per_bar);
    EXPECT_EQ(other.confidence, beat.confidence);
    EXPECT_EQ(other.playing, beat.playing);
  }
}

}  // namespace dance
