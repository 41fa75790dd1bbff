#include "producers/music/room_music.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "producers/music/control/music_control.h"

namespace dance {
namespace {

constexpr std::uint64_t kRoomClock = 5;
const MonoTime kBegin = MonoTime() + Duration::s(1000);

MonoTime after(double s) { return kBegin + Duration::seconds(s); }

Song song_with_sway(double sway, bool loops = false) {
  std::vector<GridBeat> beats;
  double at_s = 0.3;
  for (int i = 0; i < 160; ++i) {
    beats.push_back({at_s, i % 8 + 1});
    at_s += 60.0 / 180.0 * (1.0 + sway * std::sin(0.2 * i));
  }
  return Song(BeatGrid::make(beats).value(), at_s + 1.0, loops);
}

// How far the room's line is from the song, over the second in which it is the newest.
double worst_error_s(const Song& song, double seconds, std::set<std::int64_t>& lines) {
  RoomMusic room(music_title("a.ogg"), kRoomClock);
  double worst = 0.0;
  for (double s = 0.0; s < seconds; s += 1.0) {
    const Music music = room.update(song, kBegin, after(s));
    EXPECT_TRUE(is_valid(music));
    EXPECT_TRUE(music.playing);
    lines.insert(music.start_time.since_zero_ns());
    for (double t = s; t < s + 1.0; t += 0.1)
      worst = std::max(worst, std::abs(music.beats_at(after(t)) - song.beat_at(t)) / 3.0);
  }
  return worst;
}

TEST(RoomMusic, OfASteadySongIsOneLineForEver) {
  std::set<std::int64_t> lines;
  EXPECT_LT(worst_error_s(song_with_sway(0.0), 50.0, lines), 1e-6);
  EXPECT_EQ(lines.size(), 1u);
}

TEST(RoomMusic, FollowsASongThatSways) {
  std::set<std::int64_t> lines;
  EXPECT_LT(worst_error_s(song_with_sway(0.05), 50.0, lines), 0.03);
  EXPECT_GT(lines.size(), 5u);
}

TEST(RoomMusic, TellsAFollowerWhenTheSongBegan) {
  for (const bool loops : {false, true}) {
    const Song song = song_with_sway(0.05, loops);
    RoomMusic room(music_title("a.ogg"), kRoomClock);
    const double end_s = loops ? 3.0 * song.length_s() : song.length_s();
    for (double s = 0.0; s < end_s; s += 1.3) {
      const MonoTime begin = begin_of_room_music(room.update(song, kBegin, after(s)), song);
      ASSERT_NEAR((begin - kBegin).as_seconds(), 0.0, 1e-6) << s;
    }
  }
}

TEST(RoomMusic, BeforeItBeginsItsBeginIsTold) {
  const Song song = song_with_sway(0.0);
  RoomMusic room(music_title("a.ogg"), kRoomClock);
  const Music music = room.update(song, kBegin, after(-2.0));
  EXPECT_NEAR((begin_of_room_music(music, song) - kBegin).as_seconds(), 0.0, 1e-6);
}

TEST(RoomMusic, GivesABeatToWhoHasNotTheSong) {
  const Song song = song_with_sway(0.0);
  RoomMusic room(music_title("a.ogg"), kRoomClock);
  const Music music = room.update(song, kBegin, after(3.0));
  const Beat beat = beat_of_room_music(music, after(3.7));
  EXPECT_TRUE(is_valid(beat));
  EXPECT_EQ(beat.beat, std::floor(song.beat_at(3.7)) + 1.0);
  EXPECT_NEAR(beat.beats_at(after(3.7)), song.beat_at(3.7), 1e-6);
  EXPECT_EQ(beat.beats_per_bar, 8);
}

TEST(RoomMusic, StoppedStandsWhereItStopped) {
  const Song song = song_with_sway(0.0);
  RoomMusic room(music_title("a.ogg"), kRoomClock);
  room.update(song, kBegin, after(3.0));
  const Music music = room.update_stopped(9.5, after(4.0));
  EXPECT_FALSE(music.playing);
  EXPECT_EQ(music.beats_at(after(60.0)), 9.5);
}

TEST(MusicTitle, IsTheFilesNameWithinATitlesLength) {
  EXPECT_EQ(music_title("songs/No Frills Salsa.ogg").view(), "No Frills Salsa");
  EXPECT_EQ(music_title("song").view(), "song");
  EXPECT_EQ(music_title("a\nb.ogg").view(), "a?b");
  EXPECT_EQ(music_title("song\u202egpj.ogg").view(), "song?gpj");
  EXPECT_EQ(music_title("").view(), "music");
  const std::string notes = "\xe2\x99\xab";
  std::string name;
  for (int i = 0; i < 30; ++i) name += notes;
  EXPECT_EQ(music_title(name + ".ogg").view(), name.substr(0, 63));
  EXPECT_EQ(music_title("x" + name).view(), ("x" + name).substr(0, 61)) << "no half letter";
}

TEST(MusicControl, ParsesVolumesSpeedsAndCommandsAndNothingElse) {
  for (const auto& [line, volume] : {std::pair{"volume 0.4", 0.4}, {"volume 0", 0.0}}) {
    const auto command = parse_music_command(line);
    ASSERT_TRUE(command) << line;
    EXPECT_EQ(command->what, MusicCommand::What::kVolume);
    EXPECT_EQ(command->volume, volume);
  }
  for (const char* line : {"volume 1", "next", "play", "pause", "slower", "faster", "lock",
                           "unlock", "style bachata", "speed 0.85", "speed 1.1", "speed 0.5"}) {
    const auto command = parse_music_command(line);
    ASSERT_TRUE(command) << line;
    EXPECT_EQ(text_of(*command), line);
  }
  for (const char* wrong : {"",
                            "volume",
                            "volume ",
                            "volume 1.01",
                            "volume -0.1",
                            "volume 0.5x",
                            "volume nan",
                            "Volume 1",
                            "volume  1",
                            "mute",
                            "next ",
                            "speed",
                            "speed ",
                            "speed 0.49",
                            "speed 1.11",
                            "speed nan",
                            "speed 1x",
                            "speed -1",
                            "style",
                            "style a-name-that-is-too-long"})
    EXPECT_FALSE(parse_music_command(wrong)) << wrong;
}

}  // namespace
}  // namespace dance
