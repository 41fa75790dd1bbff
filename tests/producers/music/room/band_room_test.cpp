#include "producers/music/room/band_room.h"

#include <gtest/gtest.h>

namespace dance {
namespace {

constexpr std::uint64_t kClock = 7;
const GuestId kAnn = *GuestId::parse("ann"), kBob = *GuestId::parse("bob");

MonoTime at(double s) { return MonoTime::from_us(1'000'000'000) + Duration::seconds(s); }

BandRoom::Options ann(bool follows) {
  BandRoom::Options options;
  options.guest = kAnn;
  options.follows = follows;
  options.seed = 11;
  options.clock_id = kClock;
  return options;
}

RoomSong song_of_bob() {
  RoomSong song;
  song.clock_id = kClock;
  song.start_time = at(-20.0);
  song.seed = 5;
  song.style = static_cast<int>(BandStyle::kTango);
  song.playing = true;
  song.tempo_centi_bpm[0] = 100 * usual_tempo_bpm(BandStyle::kTango);
  return song;
}

TEST(BandRoom, BeginsAtOnceInAHouseWithoutARoom) {
  BandRoom room(ann(false), at(0.0));
  room.work(at(0.0));
  ASSERT_TRUE(room.song());
  EXPECT_EQ(room.song()->seed, 11u);
  EXPECT_TRUE(room.plays(at(0.0)));
  EXPECT_LT((room.song()->start_time - at(0.0)).as_seconds(), 1.0);
}

TEST(BandRoom, PlaysTheRoomsSongAndRequestsNone) {
  BandRoom room(ann(true), at(0.0));
  room.work(at(0.5));
  EXPECT_FALSE(room.song());
  room.on_room_song(kBob, song_of_bob(), at(1.0));
  room.work(at(10.0));
  ASSERT_TRUE(room.song());
  EXPECT_EQ(room.song()->seed, 5u);
  EXPECT_FALSE(room.request()) << "nothing is requested of the room";
}

TEST(BandRoom, BeginsASongWhereTheRoomHasNoneAndYieldsToAnotherHouse) {
  BandRoom room(ann(true), at(0.0));
  room.work(at(3.0));
  EXPECT_FALSE(room.request());
  room.work(at(3.6));
  ASSERT_TRUE(room.request());
  EXPECT_TRUE(room.plays(at(3.6)));
  // Bob's house requested a song at the same moment, and the server accepted his.
  room.on_room_song(kBob, song_of_bob(), at(3.7));
  room.on_room_song(kBob, song_of_bob(), at(5.7));
  EXPECT_EQ(room.song()->seed, 5u);
  EXPECT_FALSE(room.request());
}

TEST(BandRoom, PlaysARequestedSongOnceTheRoomHasAcceptedIt) {
  BandRoom room(ann(true), at(0.0));
  room.on_room_song(kBob, song_of_bob(), at(1.0));
  room.play_next(at(2.0));
  ASSERT_TRUE(room.request());
  const RoomSong requested = *room.request();
  EXPECT_NE(requested.seed, 5u);
  EXPECT_EQ(room.song()->seed, 5u);
  room.on_room_song(kBob, song_of_bob(), at(2.5));
  EXPECT_TRUE(room.request()) << "it has not arrived yet";
  room.on_room_song(kAnn, requested, at(2.7));
  EXPECT_EQ(room.song()->seed, requested.seed);
  EXPECT_EQ(room.song()->start_beat % 4, 0);
  EXPECT_GT(room.song()->start_beat, 0) << "beats count on";
}

TEST(BandRoom, DropsARequestThatTheRoomRefuses) {
  BandRoom room(ann(true), at(0.0));
  room.on_room_song(kBob, song_of_bob(), at(1.0));
  room.play_style(BandStyle::kWaltz, at(2.0));
  room.on_room_song(kBob, song_of_bob(), at(3.0));
  room.on_room_song(kBob, song_of_bob(), at(4.0));
  EXPECT_FALSE(room.request());
  EXPECT_EQ(room.song()->style, static_cast<int>(BandStyle::kTango));
}

TEST(BandRoom, ChangesTheTempoAtABarAfterTheNotice) {
  BandRoom room(ann(false), at(0.0));
  room.work(at(0.0));
  const RoomSong before = *room.song();
  const MonoTime now = at(20.0);
  ASSERT_TRUE(room.change_tempo(-2, now));
  const RoomSong& after = *room.song();
  ASSERT_EQ(after.tempo_count, 2);
  EXPECT_LT(after.tempo_centi_bpm[1], after.tempo_centi_bpm[0]);
  EXPECT_EQ(after.seed, before.seed);
  EXPECT_EQ(after.start_time, before.start_time);
  const BandSet::Part& part = room.set()->part_at(0);
  const double from_s =
      static_cast<double>(part.score->bar_begin_frame(after.tempo_bar[1])) / kBandRate_hz;
  EXPECT_GE(from_s, (now + BandRoom::kNotice - after.start_time).as_seconds());
  // Another change before that bar replaces it.
  ASSERT_TRUE(room.change_tempo(1, now));
  EXPECT_EQ(room.song()->tempo_count, 2);
}

TEST(BandRoom, LimitsTheTempoToTheSlowestAndTheFastest) {
  BandRoom room(ann(false), at(0.0));
  room.work(at(0.0));
  const double usual = 100.0 * usual_tempo_bpm(BandStyle::kSalsa);
  for (int i = 0; i < 30; ++i) room.change_tempo(-1, at(10.0));
  EXPECT_EQ(room.song()->tempo_centi_bpm[1], std::lround(BandRoom::kSlowest * usual));
  EXPECT_FALSE(room.change_tempo(-1, at(10.0)));
  for (int i = 0; i < 30; ++i) room.change_tempo(1, at(10.0));
  EXPECT_EQ(room.song()->tempo_centi_bpm[1], std::lround(BandRoom::kFastest * usual));
}

TEST(BandRoom, IsSilentWhileOtherMusicPlays) {
  BandRoom room(ann(true), at(0.0));
  room.on_room_song(kBob, song_of_bob(), at(1.0));
  Music music;
  music.playing = true;
  room.on_room_music(music, at(2.0));
  EXPECT_FALSE(room.plays(at(3.0)));
  EXPECT_TRUE(room.plays(at(7.0))) << "the other music was not published for seconds";
  room.on_room_music(music, at(8.0));
  music.playing = false;
  room.on_room_music(music, at(9.0));
  EXPECT_TRUE(room.plays(at(9.0)));
  room.set_has_other_music(true);
  EXPECT_FALSE(room.plays(at(9.0)));
}

TEST(BandRoom, PausesAndPlaysTheSameSongFromItsBegin) {
  BandRoom room(ann(false), at(0.0));
  room.work(at(0.0));
  room.set_playing(false, at(30.0));
  EXPECT_FALSE(room.plays(at(30.0)));
  room.set_playing(true, at(60.0));
  EXPECT_TRUE(room.plays(at(60.0)));
  EXPECT_EQ(room.song()->seed, 11u);
  EXPECT_EQ(room.song()->start_time, at(60.0) + BandRoom::kNotice);
}

TEST(BandRoom, IgnoresASongThatBeganADayAgoOrBeginsInAMinute) {
  for (const double begin_s : {-25.0 * 3600.0, 61.0}) {
    BandRoom room(ann(true), at(0.0));
    RoomSong song = song_of_bob();
    song.start_time = at(begin_s);
    room.on_room_song(kBob, song, at(0.0));
    EXPECT_FALSE(room.song()) << begin_s;
  }
}

TEST(BandRoom, MovesTheStartOfItsOwnSetAfterManySongs) {
  BandRoom room(ann(false), at(0.0));
  room.work(at(0.0));
  const RoomSong first = *room.song();
  std::int64_t frame = 0;
  while (room.set()->part_at(frame).number < BandRoom::kRenewedAfter_songs)
    frame = room.set()->part_at(frame).end_frame;
  const double s = static_cast<double>(frame) / kBandRate_hz + 5.0;
  const MonoTime now = first.start_time + Duration::seconds(s);
  const double beat = room.set()->beat_at(s);
  room.work(now);
  EXPECT_GT(room.song()->start_time, first.start_time);
  EXPECT_NEAR(room.set()->beat_at((now - room.song()->start_time).as_seconds()), beat, 0.01);
}

TEST(BandRoom, AddsUpTempoChangesBeforeTheRoomHasAcceptedTheFirst) {
  BandRoom room(ann(true), at(0.0));
  room.on_room_song(kBob, song_of_bob(), at(1.0));
  ASSERT_TRUE(room.change_tempo(-1, at(2.0)));
  const std::int32_t one = room.request()->tempo_centi_bpm[1];
  ASSERT_TRUE(room.change_tempo(-1, at(2.1)));
  EXPECT_LT(room.request()->tempo_centi_bpm[1], one);
}

TEST(BandRoom, IgnoresSongsOfAnotherClock) {
  BandRoom room(ann(true), at(0.0));
  RoomSong song = song_of_bob();
  song.clock_id = kClock + 1;
  room.on_room_song(kBob, song, at(1.0));
  EXPECT_FALSE(room.song());
}

}  // namespace
}  // namespace dance
