#include "producers/music/beat_grid.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace dance {
namespace {

std::vector<GridBeat> even_beats(int count, double first_s, double period_s, int bar,
                                 int first_position) {
  std::vector<GridBeat> beats;
  for (int i = 0; i < count; ++i)
    beats.push_back({first_s + i * period_s, bar ? (first_position - 1 + i) % bar + 1 : 0});
  return beats;
}

BeatGrid grid_of(const std::vector<GridBeat>& beats) {
  auto grid = BeatGrid::make(beats);
  EXPECT_TRUE(grid) << (grid ? "" : grid.error().what);
  return *grid;
}

std::string grid_error(const std::vector<GridBeat>& beats) {
  const auto grid = BeatGrid::make(beats);
  return grid ? "no error" : grid.error().what;
}

TEST(BeatGrid, CountsFromTheFirstBeatOfTheFirstBar) {
  const BeatGrid grid = grid_of(even_beats(16, 0.5, 0.4, 4, 3));
  EXPECT_EQ(grid.beats_per_bar(), 4);
  EXPECT_DOUBLE_EQ(grid.first_beat(), 2.0);
  EXPECT_DOUBLE_EQ(grid.beat_at(0.5), 2.0);
  EXPECT_NEAR(grid.beat_at(0.7), 2.5, 1e-12);
  EXPECT_NEAR(grid.time_of(4.0), 1.3, 1e-12) << "the first beat of the second bar";
  EXPECT_NEAR(grid.tempo_bpm(7.0), 150.0, 1e-9);
}

TEST(BeatGrid, GoesOnBeyondItsEndsAtTheTempoThere) {
  const BeatGrid grid = grid_of(even_beats(8, 1.0, 0.5, 4, 1));
  EXPECT_NEAR(grid.beat_at(0.0), -2.0, 1e-12);
  EXPECT_NEAR(grid.time_of(-2.0), 0.0, 1e-12);
  EXPECT_NEAR(grid.beat_at(10.0), 18.0, 1e-9);
  EXPECT_NEAR(grid.time_of(18.0), 10.0, 1e-9);
}

TEST(BeatGrid, NumberAndSecondsLeadToEachOtherWhereTheTempoWanders) {
  std::vector<GridBeat> beats;
  double time_s = 0.3;
  for (int i = 0; i < 200; ++i) {
    beats.push_back({time_s, i % 8 + 1});
    time_s += 0.36 + 0.03 * std::sin(0.3 * i);
  }
  const BeatGrid grid = grid_of(beats);
  double before = -1e9;
  for (double t = 0.0; t < 80.0; t += 0.013) {
    const double beat = grid.beat_at(t);
    ASSERT_GT(beat, before);
    ASSERT_NEAR(grid.time_of(beat), t, 1e-9);
    before = beat;
  }
}

TEST(BeatGrid, TheOddMillisecondIsNoChangeOfTempoAndAChangeIsHeardAtOnce) {
  std::vector<GridBeat> beats = even_beats(16, 0.0, 0.4, 0, 0);
  beats[6].time_s += 0.006;
  const BeatGrid jittered = grid_of(beats);
  for (double beat = 0; beat < 16; ++beat) EXPECT_NEAR(jittered.tempo_bpm(beat), 150.0, 0.8);

  beats = even_beats(8, 0.0, 0.4, 0, 0);
  for (int i = 1; i <= 8; ++i) beats.push_back({2.8 + i * 60.0 / 190.0, 0});
  const BeatGrid stepped = grid_of(beats);
  EXPECT_NEAR(stepped.tempo_bpm(7.0), 150.0, 1e-9) << "the way to this beat is still slow";
  EXPECT_NEAR(stepped.tempo_bpm(8.0), 190.0, 1e-9);
  EXPECT_NEAR(stepped.tempo_bpm(15.0), 190.0, 1e-9);
}

TEST(BeatGrid, BarsOfDifferentLengthsAreNotCounted) {
  std::vector<GridBeat> beats = even_beats(9, 0.0, 0.5, 4, 1);
  beats.push_back({4.5, 1});
  EXPECT_EQ(grid_of(beats).beats_per_bar(), 0);
  EXPECT_DOUBLE_EQ(grid_of(beats).first_beat(), 0.0);
}

TEST(BeatGrid, SaysWhichBeatIsWrong) {
  EXPECT_NE(grid_error({{1.0, 1}}).find("at least two"), std::string::npos);
  EXPECT_NE(grid_error({{1.0, 1}, {0.5, 2}}).find("beat 2"), std::string::npos);
  EXPECT_NE(grid_error({{1.0, 1}, {1.1, 2}}).find("0.15 to 3 s"), std::string::npos);
  EXPECT_NE(grid_error({{1.0, 1}, {4.1, 2}}).find("0.15 to 3 s"), std::string::npos);
  EXPECT_NE(grid_error({{1.0, 1}, {1.5, 17}}).find("0 to 16"), std::string::npos);
  EXPECT_NE(grid_error({{1.0, 1}, {1.5, -1}}).find("0 to 16"), std::string::npos);
  EXPECT_NE(grid_error({{std::nan(""), 1}, {1.5, 1}}).find("beat 1"), std::string::npos);
  EXPECT_NE(grid_error({{1.0, 1}, {std::numeric_limits<double>::infinity(), 1}}).find("beat 2"),
            std::string::npos);
}

}  // namespace
}  // namespace dance
