// Compares the sound of a recording with the scores of its songs.
#include "viewer/replay/sound/sound_track.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/test_folder.h"
#include "tests/viewer/replay/sound_recording.h"

namespace dance {
namespace {

// Returns a part of stereo samples; seconds count from their begin.
std::vector<float> part_of(const std::vector<float>& stereo, double from_s, double to_s) {
  const auto at = [](double s) {
    return 2 * static_cast<std::ptrdiff_t>(std::llround(s * SoundTrack::kSoundRate_hz));
  };
  return {stereo.begin() + at(from_s), stereo.begin() + at(to_s)};
}

float loudest(const std::vector<float>& stereo) {
  float most = 0.0f;
  for (const float sample : stereo) most = std::max(most, std::abs(sample));
  return most;
}

class SoundTrackTest : public ::testing::Test {
 protected:
  std::unique_ptr<SoundTrack> track(SoundRecording& recording, double from_s, double to_s) {
    if (index_ == nullptr) index_ = recording.write(log_);
    auto made =
        SoundTrack::open(log_, *index_, {SoundRecording::at(from_s), SoundRecording::at(to_s)}, {});
    EXPECT_TRUE(made) << made.error().what;
    return std::move(*made);
  }

  TestFolder folder_{"sound-track"};
  std::string log_ = folder_.path("night.lcm");
  std::shared_ptr<const ReplayIndex> index_;
};

TEST_F(SoundTrackTest, PlaysTheBandFromTheScoreAtTheSongsFrames) {
  const RoomSong song = room_song(BandStyle::kSalsa, 9, -5.0);
  SoundRecording recording(6.0);
  recording.add_song(0.9, 6.0, song);  // first published late, but in force since the begin
  recording.add_beats(0.0, 6.0, song);
  const auto sound = read_track(*track(recording, 0.0, 4.0), 4.0);
  EXPECT_EQ(part_of(sound, 0.01, 4.0), part_of(score_sound(song, 0.0, 4.0), 0.01, 4.0));
  EXPECT_GT(loudest(sound), 0.05f);
  // A range is the same part of the song.
  auto later = track(recording, 1.234, 3.0);
  EXPECT_EQ(part_of(read_track(*later, 1.5), 0.01, 1.5),
            part_of(score_sound(song, 1.234, 1.5), 0.01, 1.5));
  EXPECT_EQ(later->description(), "house band (salsa)");
  EXPECT_EQ(later->missing(), "");
}

TEST_F(SoundTrackTest, FollowsTempoChangesStopsAndOtherSongs) {
  const RoomSong first = room_song(BandStyle::kSalsa, 9, -5.0);
  RoomSong faster = first;
  faster.tempo_count = 2;
  faster.tempo_bar[1] = 8;
  faster.tempo_centi_bpm[1] = first.tempo_centi_bpm[0] * 21 / 20;
  RoomSong stopped = faster;
  stopped.playing = false;
  const RoomSong next = room_song(BandStyle::kBachata, 77, 11.0);
  SoundRecording recording(16.0);
  recording.add_song(0.0, 3.0, first);
  recording.add_song(3.0, 8.0, faster);
  recording.add_song(8.0, 9.0, stopped);
  recording.add_song(9.0, 16.0, next);
  auto all = track(recording, 0.0, 14.0);
  const auto sound = read_track(*all, 14.0);
  EXPECT_EQ(part_of(sound, 0.01, 8.0), part_of(score_sound(faster, 0.0, 8.0), 0.01, 8.0));
  EXPECT_NE(part_of(sound, 0.01, 8.0), part_of(score_sound(first, 0.0, 8.0), 0.01, 8.0));
  EXPECT_EQ(loudest(part_of(sound, 8.01, 11.0)), 0.0f);
  EXPECT_EQ(part_of(sound, 11.0, 14.0), score_sound(next, 11.0, 3.0));
  EXPECT_EQ(all->description(), "house band (bachata and salsa)");
}

TEST_F(SoundTrackTest, PlaysASongThatWasRequestedInAHouseWithoutARoom) {
  const RoomSong song = room_song(BandStyle::kTango, 3, -5.0);
  SoundRecording recording(4.0);
  for (int i = 0; i < 4; ++i)
    recording.add(i, Channel::of(Signal::kSong, Where::kCapture, *GuestId::parse("alice")), song);
  const auto sound = read_track(*track(recording, 0.0, 3.0), 3.0);
  EXPECT_EQ(part_of(sound, 0.01, 3.0), part_of(score_sound(song, 0.0, 3.0), 0.01, 3.0));
}

TEST_F(SoundTrackTest, IsSilentWhileOtherMusicPlaysAndNamesIt) {
  const RoomSong song = room_song(BandStyle::kSalsa, 9, -5.0);
  SoundRecording recording(8.0);
  recording.add_song(0.0, 8.0, song);
  Music music;
  music.clock_id = SoundRecording::kClock;
  music.playing = true;
  ASSERT_TRUE(music.title.assign("Blue Danube"));
  for (int s = 3; s < 8; ++s)
    recording.add(s, Channel::of(Signal::kMusic, Where::kRoom, *GuestId::parse("bob")), music);
  auto all = track(recording, 0.0, 7.0);
  const auto sound = read_track(*all, 7.0);
  EXPECT_GT(loudest(part_of(sound, 1.0, 3.0)), 0.05f);
  EXPECT_EQ(loudest(part_of(sound, 3.01, 7.0)), 0.0f);
  EXPECT_EQ(all->missing(), "the music 'Blue Danube' is not recorded");
}

TEST_F(SoundTrackTest, IsSilentWhileTheRecordedBeatsAreNotTheSongs) {
  const RoomSong song = room_song(BandStyle::kSalsa, 9, -5.0);
  SoundRecording recording(8.0);
  recording.add_song(0.0, 8.0, song);
  recording.add_beats(0.0, 3.0, song);
  recording.add_beats(3.0, 8.0, song, 0.5);
  auto all = track(recording, 0.0, 7.0);
  const auto sound = read_track(*all, 7.0);
  EXPECT_GT(loudest(part_of(sound, 1.0, 3.0)), 0.05f);
  EXPECT_EQ(loudest(part_of(sound, 3.6, 7.0)), 0.0f);
  EXPECT_EQ(all->missing(), "the music is not recorded, only its beats are");
}

TEST_F(SoundTrackTest, FindsNothingInARecordingOfOtherMusic) {
  SoundRecording recording(4.0);
  recording.add_beats(0.0, 4.0, room_song(BandStyle::kSalsa, 9, -5.0));
  auto all = track(recording, 0.0, 3.0);
  auto found = all->search();
  while (found == SoundTrack::Search::kGoesOn) found = all->search();
  EXPECT_EQ(found, SoundTrack::Search::kNone);
  EXPECT_EQ(loudest(read_track(*all, 3.0)), 0.0f);
  EXPECT_EQ(all->description(), "");
  EXPECT_EQ(all->missing(), "the music is not recorded, only its beats are");
}

TEST_F(SoundTrackTest, HasTheSameSamplesHoweverItIsRead) {
  SoundRecording recording(8.0);
  recording.add_song(0.0, 4.0, room_song(BandStyle::kSalsa, 9, -5.0));
  recording.add_song(4.0, 8.0, room_song(BandStyle::kWaltz, 2, 3.0));
  EXPECT_EQ(read_track(*track(recording, 0.5, 7.0), 6.5, 1600),
            read_track(*track(recording, 0.5, 7.0), 6.5, 333));
}

TEST_F(SoundTrackTest, IgnoresSongsOfOtherClocksAndOfOtherDays) {
  RoomSong foreign = room_song(BandStyle::kSalsa, 9, -5.0);
  foreign.clock_id = 8;
  SoundRecording recording(4.0);
  recording.add_song(0.0, 4.0, foreign);
  recording.add_song(0.5, 4.0, room_song(BandStyle::kSalsa, 9, 3600.0));
  EXPECT_EQ(loudest(read_track(*track(recording, 0.0, 3.0), 3.0)), 0.0f);
}

}  // namespace
}  // namespace dance
