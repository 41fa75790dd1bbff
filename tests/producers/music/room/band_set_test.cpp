#include "producers/music/room/band_set.h"

#include <gtest/gtest.h>

namespace dance {
namespace {

RoomSong salsa(std::uint32_t seed) {
  RoomSong song;
  song.clock_id = 7;
  song.start_time = MonoTime::from_us(1'000'000'000);
  song.start_beat = 64;
  song.seed = seed;
  song.playing = true;
  song.tempo_centi_bpm[0] = 100 * usual_tempo_bpm(BandStyle::kSalsa);
  return song;
}

double seconds_at(std::int64_t frame) { return static_cast<double>(frame) / kBandRate_hz; }

TEST(BandSet, PlaysSongsOneAfterTheOtherWithoutALostBeat) {
  BandSet set;
  ASSERT_TRUE(set.set(salsa(3)));
  std::int64_t frame = 0;
  double beat = 64.0;
  for (int number = 0; number < 5; ++number) {
    const BandSet::Part part = set.part_at(frame);
    EXPECT_EQ(part.number, number);
    EXPECT_EQ(part.begin_frame, frame);
    EXPECT_EQ(part.begin_beat, beat);
    EXPECT_NEAR(set.beat_at(seconds_at(frame)), beat, 1e-6);
    frame = part.end_frame;
    const double bars = (set.part_at(frame).begin_beat - beat) / set.beats_per_bar();
    EXPECT_EQ(bars, part.score->bars() + BandSet::kRest_bars);
    beat = set.part_at(frame).begin_beat;
  }
}

TEST(BandSet, CountsBeatsThroughTheRestBetweenTwoSongs) {
  BandSet set;
  ASSERT_TRUE(set.set(salsa(4)));
  const BandSet::Part part = set.part_at(0);
  double s = seconds_at(part.end_frame) - 6.0;
  double last = set.next_beat(s).beat;
  for (int i = 0; i < 30; ++i) {
    const Song::NextBeat next = set.next_beat(s);
    EXPECT_GT(next.song_s, s);
    EXPECT_EQ(next.beat, last + (i == 0 ? 0.0 : 1.0));
    last = next.beat;
    s = next.song_s;
  }
}

TEST(BandSet, FindsTheSameSongForALateJoiner) {
  BandSet early, late;
  ASSERT_TRUE(early.set(salsa(5)));
  ASSERT_TRUE(late.set(salsa(5)));
  std::int64_t frame = 0;
  while (early.part_at(frame).number < 6) frame += 10 * kBandRate_hz;
  const BandSet::Part& joined = late.part_at(frame);
  EXPECT_EQ(joined.number, 6);
  EXPECT_EQ(joined.score->song().seed, early.part_at(frame).score->song().seed);
  EXPECT_EQ(joined.begin_frame, early.part_at(frame).begin_frame);
  // The same set, asked for an earlier song.
  EXPECT_EQ(late.part_at(0).number, 0);
}

TEST(BandSet, MakesARoomSongOfALaterSongWithTheSameBeats) {
  BandSet set, rest;
  ASSERT_TRUE(set.set(salsa(6)));
  const std::int64_t frame = set.part_at(0).end_frame + 20 * kBandRate_hz;
  const BandSet::Part part = set.part_at(frame);
  const RoomSong song = set.song_from(part, salsa(6).start_time);
  ASSERT_TRUE(is_valid(song));
  ASSERT_TRUE(rest.set(song));
  const double begin_s = (song.start_time - salsa(6).start_time).as_seconds();
  EXPECT_NEAR(begin_s, seconds_at(part.begin_frame), 1e-6);
  for (const double s : {0.0, 33.3, 250.0})
    EXPECT_NEAR(rest.beat_at(s), set.beat_at(s + begin_s), 1e-3);
}

TEST(BandSet, RefusesSongsThatNoBandPlaysAndKeepsTheOneBefore) {
  BandSet set;
  EXPECT_FALSE(set.is_set());
  RoomSong song = salsa(1);
  song.tempo_centi_bpm[0] = 40000;
  EXPECT_FALSE(set.set(song));
  EXPECT_FALSE(set.is_set());
  ASSERT_TRUE(set.set(salsa(1)));
  song = salsa(2);
  song.tempo_bar[1] = 1;
  EXPECT_FALSE(set.set(song));
  EXPECT_EQ(set.part_at(0).score->song().seed, 1u);
}

}  // namespace
}  // namespace dance
