#include "producers/music/song.h"

#include <gtest/gtest.h>

#include <cmath>

namespace dance {
namespace {

// 16 beats of 0.5 s, the first at 0.1 s, in bars of four.
BeatGrid song_grid(int first_position = 1) {
  std::vector<GridBeat> beats;
  for (int i = 0; i < 16; ++i) beats.push_back({0.1 + 0.5 * i, (first_position - 1 + i) % 4 + 1});
  return BeatGrid::make(beats).value();
}

TEST(Song, CountsOnFromRoundToRoundInWholeBars) {
  const Song song(song_grid(), 8.0, true);
  EXPECT_NEAR(song.beat_at(0.1), 0.0, 1e-12);
  EXPECT_NEAR(song.beat_at(4.1), 8.0, 1e-12);
  EXPECT_NEAR(song.beat_at(8.1), 16.0, 1e-12);
  EXPECT_NEAR(song.beat_at(16.1), 32.0, 1e-12);
  EXPECT_FALSE(song.is_over(100.0));

  // A round that ends within its last bar: the next begins with a bar all the same.
  const Song cut(song_grid(), 7.0, true);
  EXPECT_NEAR(cut.beat_at(7.1), 16.0, 1e-12);
  EXPECT_NEAR(cut.beat_at(6.9), 13.6, 1e-12);
}

TEST(Song, BeatsAndSecondsLeadToEachOtherInEveryRound) {
  for (const double length_s : {8.0, 7.0, 8.3}) {
    const Song song(song_grid(), length_s, true);
    for (double s = 0.0; s < 30.0; s += 0.017)
      ASSERT_NEAR(song.time_of(song.beat_at(s)), s, 1e-9) << length_s;
  }
}

TEST(Song, NextBeatIsEveryBeatOnceAndAscends) {
  for (const double length_s : {8.0, 7.0, 8.3}) {
    const Song song(song_grid(), length_s, true);
    double at_s = 0.0;
    double before = -1.0;
    for (int i = 0; i < 60; ++i) {
      const Song::NextBeat next = song.next_beat(at_s);
      ASSERT_GT(next.song_s, at_s);
      ASSERT_LE(next.song_s - at_s, 1.0);
      ASSERT_GT(next.beat, before);
      ASSERT_EQ(next.beat, std::round(next.beat));
      ASSERT_NEAR(song.beat_at(next.song_s), next.beat, 1e-9);
      at_s = next.song_s;
      before = next.beat;
    }
  }
}

TEST(Song, EndsWhereItDoesNotLoop) {
  const Song song(song_grid(), 8.0, false);
  EXPECT_FALSE(song.is_over(7.9));
  EXPECT_TRUE(song.is_over(8.0));
  EXPECT_NEAR(song.beat_at(9.1), 18.0, 1e-9) << "it goes on at the tempo of its end";
}

TEST(Song, AnUpbeatKeepsTheBars) {
  const Song song(song_grid(4), 8.0, true);
  EXPECT_NEAR(song.beat_at(0.1), 3.0, 1e-12) << "the fourth of a bar";
  EXPECT_NEAR(song.beat_at(0.6), 4.0, 1e-12);
  EXPECT_EQ(std::fmod(song.beat_at(8.6), 4.0), 0.0);
}

TEST(Song, AtAnotherSpeedHasTheSameBeatsLaterOrEarlier) {
  for (const bool loops : {false, true})
    for (const double speed : {0.5, 0.8, 1.1}) {
      const Song own(song_grid(), 8.3, loops);
      Song changed = own;
      changed.set_speed(speed);
      EXPECT_NEAR(changed.length_s(), own.length_s() / speed, 1e-12);
      EXPECT_NEAR(changed.tempo_bpm(3.0), 120.0 * speed, 1e-9);
      for (double s = 0.0; s < 20.0; s += 0.37) {
        ASSERT_NEAR(changed.beat_at(s / speed), own.beat_at(s), 1e-9) << speed;
        ASSERT_NEAR(changed.time_of(own.beat_at(s)), own.time_of(own.beat_at(s)) / speed, 1e-9);
        const Song::NextBeat next = changed.next_beat(s / speed);
        ASSERT_GT(next.song_s, s / speed);
        ASSERT_NEAR(changed.beat_at(next.song_s), next.beat, 1e-9);
      }
    }
}

}  // namespace
}  // namespace dance
