// The tracker on real songs beside this tree, where they are there.
#include <gtest/gtest.h>

#include <filesystem>

#include "research/beats/music_eval.h"

namespace dance {
namespace {

namespace fs = std::filesystem;

TEST(BeatSongs, AreTrackedCausallyAndInTheirOwnOctave) {
  const fs::path folder = DANCE_SOURCE_DIR "/../shared/data/music";
  if (!fs::exists(folder)) GTEST_SKIP() << folder << " is missing: no real songs beside this tree";
  double sum = 0.0;
  double deviations_s = 0.0;
  int songs = 0;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (entry.path().extension() != ".ogg") continue;
    const fs::path beats = fs::path(entry.path()).replace_extension(".beats");
    // One is enough: what is causal does not hang on the song.
    MusicEvalOptions options;
    options.with_aubio = false;
    options.check_causal = songs == 0;
    const auto song = evaluate_song(entry.path(), beats, options);
    ASSERT_TRUE(song) << song.error().what;
    EXPECT_EQ(song->causal.has_value(), songs == 0) << song->name;
    EXPECT_TRUE(song->causal.value_or(true)) << song->name;
    EXPECT_LE(song->tempo_error_percent, 4.0) << song->name;
    EXPECT_GE(song->score.f_measure(), 0.9) << song->name;
    EXPECT_LE(std::abs(song->score.mean_error_s), 0.015) << song->name;
    EXPECT_LE(song->score.sd_error_s, 0.015) << song->name;
    sum += song->score.f_measure();
    deviations_s += song->score.sd_error_s;
    ++songs;
  }
  if (songs == 0) GTEST_SKIP() << folder << " has no songs";
  EXPECT_GE(sum / songs, 0.98);
  EXPECT_LE(deviations_s / songs, 0.010);
}

}  // namespace
}  // namespace dance
