// Files that a house plays alone: what its windows are told, and what a dancer may do.
#include "producers/music/file/file_deck.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>

#include "core/base/music/music_speed.h"
#include "core/net/mono_clock.h"
#include "producers/music/file/song_folder.h"
#include "tests/core/bus/port_double.h"
#include "tests/producers/music/wav_file.h"
#include "tests/test_folder.h"

namespace dance {
namespace {

constexpr int kDeckRate_hz = 8000;

// Keeps the time, and records what it was told.
class DeckPlayer : public SilentPlayer {
 public:
  DeckPlayer(double& volume, double& speed) : volume_(volume), speed_(speed) {}
  void set_volume(double volume) override { volume_ = volume; }
  void set_speed(double speed) override { speed_ = speed; }

 private:
  double& volume_;
  double& speed_;
};

class FileDeckTest : public testing::Test {
 protected:
  FileDeckTest() {
    auto poller = Poller::create();
    EXPECT_TRUE(poller);
    poller_ = std::move(*poller);
    port_.subscribe<Beat>(Where::kLocal,
                          [this](const Channel&, const Beat& beat, MonoTime) { beat_ = beat; });
    port_.subscribe<Music>(
        Where::kCapture, [this](const Channel&, const Music& music, MonoTime) { music_ = music; });
  }
  // Clicks at 120 a minute, with the list of them or without.
  std::string write_song(const std::string& name, bool has_list) {
    std::vector<double> beats_s;
    for (int i = 0; i < 16; ++i) beats_s.push_back(0.1 + 0.5 * i);
    const std::string path = folder_.path(name + ".wav");
    write_wav(path, click_track(beats_s, 8.3, kDeckRate_hz), 1, kDeckRate_hz);
    if (!has_list) return path;
    std::ofstream list(folder_.path(name + ".beats"));
    for (std::size_t i = 0; i < beats_s.size(); ++i)
      list << beats_s[i] << "\t" << i % 4 + 1 << "\n";
    return path;
  }
  void open(const std::string& path, bool is_alone = true) {
    FileDeck::Options options;
    options.file = {path, ""};
    options.is_alone = is_alone;
    options.begin = [](MonoTime now) { return Result<MonoTime>(now); };
    options.make_player = [this](AudioFile) {
      return std::make_unique<DeckPlayer>(volume_, speed_);
    };
    deck_ = std::make_unique<FileDeck>(options, *poller_);
    MusicProgramOptions program;
    program.loops = true;
    program.guest = *GuestId::parse("ann");
    program.begin = mono_now();
    auto player = deck_->open(program);
    ASSERT_TRUE(player) << player.error().what;
    program_ =
        std::make_unique<MusicProgram>(std::move(program), std::move(*player), port_, *poller_);
    deck_->run(*program_);
  }
  // Runs until something is so.
  bool until(const std::function<bool()>& done) {
    const MonoTime end = mono_now() + Duration::s(60);
    while (!done()) {
      if (mono_now() > end) return false;
      port_.now = mono_now();
      poller_->run_once(Duration::ms(5));
    }
    return true;
  }
  void command(const char* line) {
    const auto parsed = parse_music_command(line);
    ASSERT_TRUE(parsed) << line;
    deck_->apply(*parsed);
  }
  bool is_titled(const char* title) const { return music_ && music_->title.view() == title; }

  TestFolder folder_{"file-deck"};
  PortDouble port_;
  std::unique_ptr<Poller> poller_;
  std::unique_ptr<FileDeck> deck_;
  std::unique_ptr<MusicProgram> program_;
  double volume_ = -1.0, speed_ = -1.0;
  std::optional<Beat> beat_;
  std::optional<Music> music_;
};

TEST_F(FileDeckTest, NamesASongWhoseBeatsAreSoughtAndThenPublishesThem) {
  open(write_song("My Song", false));
  ASSERT_TRUE(until([&] { return music_.has_value(); }));
  EXPECT_TRUE(is_titled("My Song"));
  EXPECT_TRUE(music_->playing) << "it is heard already";
  ASSERT_TRUE(until([&] { return beat_ && beat_->playing; }));
  EXPECT_NEAR(beat_->tempo_bpm, 120.0, 3.0);
}

TEST_F(FileDeckTest, StopsAndPlaysOnWhereItWas) {
  open(write_song("a", true));
  ASSERT_TRUE(until([&] { return beat_ && beat_->playing && beat_->beat >= 2.0; }));
  command("pause");
  ASSERT_TRUE(until([&] { return !beat_->playing && !music_->playing; }));
  const double stopped_at = beat_->beat;
  EXPECT_GE(stopped_at, 0.9);
  command("play");
  ASSERT_TRUE(until([&] { return beat_->playing && music_->playing; }));
  EXPECT_GE(beat_->beat, std::floor(stopped_at));
  EXPECT_LE(beat_->beat, stopped_at + 2.0);
}

TEST_F(FileDeckTest, ChangesItsSpeedAndKeepsItsPlaceInTheSong) {
  open(write_song("a", true));
  ASSERT_TRUE(until([&] { return beat_ && beat_->playing && beat_->beat >= 2.0; }));
  const double before = beat_->beats_at(mono_now());
  const MonoTime at = mono_now();
  command("speed 0.5");
  EXPECT_EQ(speed_, 0.5);
  ASSERT_TRUE(until([&] { return std::abs(beat_->tempo_bpm - 60.0) < 0.1; }));
  const double seconds = (mono_now() - at).as_seconds();
  const double gone = beat_->beats_at(mono_now()) - before;
  EXPECT_GE(gone, 1.0 * seconds - 0.3) << "at least at half of the speed";
  EXPECT_LE(gone, 2.0 * seconds + 0.3) << "at most at all of it";
  command("faster");
  EXPECT_EQ(speed_, 0.55);
}

TEST_F(FileDeckTest, PlaysTheNextSongOfItsFolderAsLoudAndAsFast) {
  write_song("b", true);
  std::ofstream(folder_.path("a2.wav")) << "no music";
  open(write_song("a", true));
  command("volume 0.3");
  command("speed 0.8");
  volume_ = speed_ = -1.0;
  command("next");
  ASSERT_TRUE(until([&] { return is_titled("b") && beat_ && beat_->playing; })) << "a2 is skipped";
  EXPECT_EQ(volume_, 0.3);
  EXPECT_EQ(speed_, 0.8);
  EXPECT_NEAR(beat_->tempo_bpm, 96.0, 0.1);
  command("next");
  ASSERT_TRUE(until([&] { return is_titled("a"); })) << "after the last comes the first";
}

TEST_F(FileDeckTest, ASongThatARoomMayHearIsOnlyMadeSofter) {
  open(write_song("a", true), false);
  ASSERT_TRUE(until([&] { return beat_ && beat_->playing; }));
  for (const char* line : {"pause", "speed 0.5", "next", "slower"}) command(line);
  command("volume 0.2");
  EXPECT_EQ(volume_, 0.2);
  EXPECT_EQ(speed_, -1.0);
  beat_.reset();
  ASSERT_TRUE(until([&] { return beat_.has_value(); }));
  EXPECT_TRUE(beat_->playing);
}

TEST_F(FileDeckTest, ASongWithoutBeatsEndsTheProgramWithTheReason) {
  const std::string path = folder_.path("silence.wav");
  write_wav(path, std::vector<float>(2 * kDeckRate_hz, 0.0f), 1, kDeckRate_hz);
  open(path);
  poller_->run();
  ASSERT_FALSE(deck_->result());
  EXPECT_NE(deck_->result().error().what.find("no steady beat"), std::string::npos);
}

TEST(SongFolder, ListsTheOtherSongsFromTheNextOneOn) {
  const TestFolder folder("song-folder");
  for (const char* name : {"b.ogg", "c.MP3", "a.flac", "b.beats", "notes.txt"})
    std::ofstream(folder.path(name)) << "x";
  std::filesystem::create_directory(folder.path("d.ogg"));
  const auto names = [&](const char* song) {
    std::string text;
    for (const std::string& path : songs_after(folder.path(song)))
      text += std::filesystem::path(path).filename().string() + " ";
    return text;
  };
  EXPECT_EQ(names("b.ogg"), "c.MP3 a.flac b.ogg ");
  EXPECT_EQ(names("c.MP3"), "a.flac b.ogg c.MP3 ");
  EXPECT_EQ(songs_after("/nowhere/x.ogg"), std::vector<std::string>{"/nowhere/x.ogg"});
}

TEST(MusicSpeed, GoesInStepsWithinItsBounds) {
  EXPECT_EQ(stepped_music_speed(1.0, -1), 0.95);
  EXPECT_EQ(stepped_music_speed(0.95, 1), 1.0);
  EXPECT_EQ(stepped_music_speed(0.5, -1), kLeastMusicSpeed);
  EXPECT_EQ(stepped_music_speed(1.1, 1), kMostMusicSpeed);
  EXPECT_EQ(stepped_music_speed(0.83, 0), 0.85);
}

}  // namespace
}  // namespace dance
