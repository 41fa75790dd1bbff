#include "core/pose/music_here.h"

#include <gtest/gtest.h>

namespace dance {
namespace {

constexpr std::uint64_t kHouseClock = 9;

MonoTime house_second(double s) { return MonoTime() + Duration::seconds(100.0 + s); }

Beat said_at(double s, double beat, double tempo_bpm) {
  Beat said;
  said.time = said.beat_time = house_second(s);
  said.clock_id = kHouseClock;
  said.beat = beat;
  said.tempo_bpm = tempo_bpm;
  said.beats_per_bar = 4;
  said.confidence = 1.0f;
  said.playing = true;
  return said;
}

Pose danced_at(double s, double beats) {
  Pose pose;
  pose.clock_id = kHouseClock;
  pose.capture_time = house_second(s);
  pose.music_beats = beats;
  return pose;
}

TEST(MusicHere, StandsWhereItIsSaidToStand) {
  MusicHere music(kHouseClock);
  music.hear(said_at(0.0, 8.0, 120.0));
  EXPECT_NEAR(music.clock().position(house_second(0.75)), 9.5, 1e-9);
}

TEST(MusicHere, StandsWhereTheDancersOfTheHouseAreWhileNobodySaysIt) {
  MusicHere music(kHouseClock);
  for (int i = 0; i < 60; ++i) music.see(danced_at(i / 60.0, 3.0 * i / 60.0));
  ASSERT_TRUE(music.clock().is_known(house_second(1.0)));
  EXPECT_NEAR(music.clock().position(house_second(1.2)), 3.6, 1e-6);
  EXPECT_NEAR(music.clock().beats_per_second(), 3.0, 1e-9);
}

TEST(MusicHere, BelievesWhoPlaysMoreThanWhoDances) {
  MusicHere music(kHouseClock);
  music.hear(said_at(0.0, 0.0, 120.0));
  for (int i = 0; i < 60; ++i) music.see(danced_at(i / 60.0, 100.0 + 3.0 * i / 60.0));
  EXPECT_NEAR(music.clock().position(house_second(1.0)), 2.0, 1e-9);
}

TEST(MusicHere, HearsNothingFromOtherClocksAndNothingFromPosesWithoutMusic) {
  MusicHere music(kHouseClock);
  Beat foreign = said_at(0.0, 0.0, 120.0);
  foreign.clock_id = 1;
  music.hear(foreign);
  for (int i = 0; i < 60; ++i) {
    Pose other = danced_at(i / 60.0, i * 0.05);
    other.clock_id = 1;
    music.see(other);
    music.see(danced_at(i / 60.0, kNoMusic));
  }
  EXPECT_FALSE(music.clock().is_known(house_second(1.0)));
}

TEST(MusicHere, FollowsNoDancerWhoJumps) {
  MusicHere music(kHouseClock);
  for (int i = 0; i < 8; ++i) music.see(danced_at(0.3 * i, i % 2 == 0 ? 0.0 : 1000.0));
  EXPECT_FALSE(music.clock().is_known(house_second(2.4)));
}

}  // namespace
}  // namespace dance
