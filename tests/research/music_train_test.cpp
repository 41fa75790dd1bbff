// dance music train and its parts, on songs that the test writes.
#include <gtest/gtest.h>

#include "producers/music/tracker/bar_pointer.h"
#include "research/beats/beat_model_file.h"
#include "research/beats/music_training.h"
#include "tests/research/song_on_disk.h"

namespace dance {
namespace {

constexpr double kHop_s = 0.01;

TEST(MusicTraining, FindsWhereInABarAGroupStrikes) {
  // Group 1 strikes on the second beat and half after the third; beats at 120 a minute.
  std::vector<double> beats_s;
  for (int i = 0; i <= 16; ++i) beats_s.push_back(0.5 * i);
  std::vector<OnsetStrength::Strengths> strengths(800);
  std::vector<double> times_s;
  for (std::size_t k = 0; k < strengths.size(); ++k) {
    times_s.push_back(kHop_s * static_cast<double>(k));
    for (const double at_s : {0.5, 1.25}) {
      const double away = (std::remainder(times_s[k] - at_s - BarPointer::kLater_s[1], 2.0)) /
                          BarPointer::kBlur_s[1];
      strengths[k][1] += static_cast<float>(6.0 * std::exp(-0.5 * away * away));
    }
  }
  const BarStrokes bars = strokes_of_bars(strengths, times_s, beats_s);
  constexpr std::size_t kSecondBeat = 6, kHalfAfterThird = 15;
  for (std::size_t s = 0; s < kPatternSlots; ++s) {
    if (s == kSecondBeat || s == kHalfAfterThird)
      EXPECT_GT(bars[1][s], 3.0f) << s;
    else
      EXPECT_LT(bars[1][s], 0.5f) << s;
    EXPECT_LT(bars[0][s], 0.5f) << s;
  }
}

TEST(MusicTraining, SaysThatSongsAreTooSlowToLearnFrom) {
  const SongOnDisk disk;
  disk.add("slow", 40.0, 50.0);
  const Finished refused = run(bin("dance-music-train") + " " + disk.folder.path("slow.wav") +
                               " -o " + disk.folder.path("own.model") + " --rounds 1");
  EXPECT_EQ(refused.exit_code, 1) << refused.talk;
  EXPECT_NE(refused.talk.find("slower"), std::string::npos) << refused.talk;
}

TEST(MusicTraining, LabelsWhatANetworkHearsByTheBeatsOfTheSong) {
  const SongOnDisk disk;
  disk.add("song133", 24.0, 133.0);
  const auto song =
      load_training_song(disk.folder.path("song133.wav"), disk.folder.path("song133.beats"));
  ASSERT_TRUE(song) << song.error().what;
  EXPECT_NEAR(song->least_tempo_bpm, 133.0, 0.5);
  const RhythmSong& rhythm = song->rhythm;
  ASSERT_EQ(rhythm.features.size(), rhythm.classes.size() * RhythmFeatures::kCount);
  const std::vector<double> beats_s = DrumMusic::steady(24.0, 133.0);
  const double half_s = 0.5 * 60.0 / 133.0;
  const double hop_s = std::round(22050.0 / OnsetStrength::kHops_hz) / 22050.0;
  constexpr double kOnBeat_s = 0.0151, kLimit_s = 0.001;
  std::array<int, 3> seen{};
  double all = 0.0, before_beats = 0.0, after_beats = 0.0;
  const auto rises = [&](std::size_t step) {
    double sum = 0.0;
    const float* row = &rhythm.features[step * RhythmFeatures::kCount];
    for (std::size_t b = 0; b < RhythmFeatures::kBands; ++b)
      sum += static_cast<double>(row[RhythmFeatures::kBands + RhythmFeatures::kTones + b]);
    return sum;
  };
  for (std::size_t i = 0; i < rhythm.classes.size(); ++i) {
    all += rises(i) / static_cast<double>(rhythm.classes.size());
    if (rhythm.weights[i] <= 0.0f) continue;
    ASSERT_NEAR(rhythm.tempi[i], RhythmNet::place_of_tempo(133.0), 0.2);
    const double t = static_cast<double>(i + 1) * 2.0 * hop_s - RhythmNet::kDelay_s;
    const double to_beat = std::abs(std::remainder(t - beats_s[0], 2.0 * half_s));
    const double to_half = half_s - to_beat;
    if (std::abs(to_beat - kOnBeat_s) < kLimit_s || std::abs(to_half - kOnBeat_s) < kLimit_s)
      continue;
    const int expected = to_beat < kOnBeat_s ? 0 : to_half < kOnBeat_s ? 1 : 2;
    ASSERT_EQ(rhythm.classes[i], expected) << t;
    ++seen[rhythm.classes[i]];
    // The stroke itself is heard before its label comes.
    if (expected == 0) before_beats += std::max(rises(i - 9), rises(i - 8));
    if (expected == 0) after_beats += std::max(rises(i), rises(i - 1));
  }
  EXPECT_GT(seen[0], 40);
  EXPECT_GT(seen[1], 40);
  EXPECT_GT(before_beats / seen[0], 2.0 * all);
  EXPECT_LT(after_beats, before_beats);
}

TEST(MusicTraining, TheSameSongsGiveTheSameModel) {
  const SongOnDisk disk;
  const auto song =
      load_training_song(disk.folder.path("song.wav"), disk.folder.path("song.beats"));
  ASSERT_TRUE(song) << song.error().what;
  const MusicTraining training{.rounds = 1, .patterns = 1};
  const auto one = train_beats({&*song}, training);
  const auto two = train_beats({&*song}, training);
  ASSERT_TRUE(one && two);
  EXPECT_EQ(write_beat_model(*one), write_beat_model(*two));
}

TEST(MusicTraining, AnotherStudioTellsOfTheSameBeatsWithOtherStrokes) {
  const SongOnDisk disk;
  const auto heard = [&](std::uint64_t studio) {
    auto song = load_training_song(disk.folder.path("song.wav"), disk.folder.path("song.beats"),
                                   {.speed = 1.0, .studio = studio});
    EXPECT_TRUE(song);
    return std::move(*song);
  };
  const TrainingSong plain = heard(0), other = heard(7), again = heard(7);
  EXPECT_EQ(other.rhythm.classes, plain.rhythm.classes);
  EXPECT_EQ(other.least_tempo_bpm, plain.least_tempo_bpm);
  EXPECT_NE(other.rhythm.features, plain.rhythm.features);
  EXPECT_EQ(other.rhythm.features, again.rhythm.features);
}

TEST(MusicTraining, StudiosHangOnNameWayAndSeed) {
  const std::uint64_t studio = studio_of("song.ogg", 3, 1);
  EXPECT_EQ(studio_of("song.ogg", 3, 1), studio);
  EXPECT_NE(studio_of("other.ogg", 3, 1), studio);
  EXPECT_NE(studio_of("song.ogg", 4, 1), studio);
  EXPECT_NE(studio_of("song.ogg", 3, 2), studio);
}

TEST(MusicTrain, TheSameSeedGivesTheSameModelAndAnotherSeedAnother) {
  const SongOnDisk disk;
  const auto made = [&](const std::string& name, int seed) {
    const std::string model = disk.folder.path(name);
    const Finished finished =
        run(bin("dance-music-train") + " " + disk.folder.path("song.wav") + " -o " + model +
            " --rounds 1 --patterns 1 --seed " + std::to_string(seed));
    EXPECT_EQ(finished.exit_code, 0) << finished.talk;
    const auto read = read_beat_model_file(model);
    return read ? (*read)->name : 0u;
  };
  const std::uint32_t first = made("first.model", 1);
  EXPECT_NE(first, 0u);
  EXPECT_EQ(made("again.model", 1), first);
  EXPECT_NE(made("other.model", 2), first);
}

TEST(MusicTrain, WritesAModelThatTheEvaluationTakes) {
  const SongOnDisk disk;
  const std::string song = disk.folder.path("song.wav");
  const std::string model = disk.folder.path("own.model");
  const Finished made =
      run(bin("dance") + " music train " + song + " -o " + model + " --rounds 2 --patterns 2");
  ASSERT_EQ(made.exit_code, 0) << made.talk;
  EXPECT_TRUE(read_beat_model_file(model));
  const Finished judged = run(bin("dance-music-eval") + " " + song + " --json --model " + model);
  ASSERT_EQ(judged.exit_code, 0) << judged.talk;
  const Finished wrong = run(bin("dance-music-eval") + " " + song + " --model " + song);
  EXPECT_EQ(wrong.exit_code, 1);
  EXPECT_NE(wrong.talk.find("song.wav"), std::string::npos) << wrong.talk;
}

TEST(MusicTrain, HoldsOutAPartOfTheSongsInTurn) {
  const SongOnDisk disk;
  disk.add("other", 14.0, 126.0);
  const Finished held =
      run(bin("dance-music-train") + " " + disk.folder.path("song.wav") + " " +
          disk.folder.path("other.wav") + " --hold-out 2 --rounds 2 --patterns 2");
  ASSERT_EQ(held.exit_code, 0) << held.talk;
  EXPECT_NE(held.output.find("song.wav"), std::string::npos) << held.output;
  EXPECT_NE(held.output.find("other.wav"), std::string::npos) << held.output;
  const Finished few =
      run(bin("dance-music-train") + " " + disk.folder.path("song.wav") + " --hold-out 2");
  EXPECT_EQ(few.exit_code, 2);
}

TEST(MusicTraining, NamesASongThatIsTooShort) {
  const SongOnDisk disk;
  disk.add("short", 5.0, 120.0);
  const auto song =
      load_training_song(disk.folder.path("short.wav"), disk.folder.path("short.beats"));
  ASSERT_FALSE(song);
  EXPECT_NE(song.error().what.find("short.beats"), std::string::npos);
}

}  // namespace
}  // namespace dance
