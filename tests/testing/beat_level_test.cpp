#include "testing/music/beat_level.h"

#include <gtest/gtest.h>

#include <vector>

namespace dance {
namespace {

std::vector<double> beats(double first_s, double period_s, double end_s) {
  std::vector<double> times_s;
  for (double t = first_s; t < end_s; t += period_s) times_s.push_back(t);
  return times_s;
}

const std::vector<double> kTruth_s = beats(0.5, 0.6, 60.0);

BeatLevel level_of(const std::vector<double>& told_s) {
  return level_of_beats(kTruth_s, told_s, 5.0, 55.0);
}

TEST(BeatLevel, RightBeatsHaveNoWrongLevel) {
  EXPECT_EQ(level_of(beats(0.52, 0.6, 60.0)).wrong(), 0.0);
}

TEST(BeatLevel, TellsHalfFromDoubleFromBetween) {
  const BeatLevel half = level_of(beats(0.5, 1.2, 60.0));
  EXPECT_NEAR(half.half, 1.0, 1e-9);
  EXPECT_EQ(half.twice + half.off_beat, 0.0);
  const BeatLevel twice = level_of(beats(0.5, 0.3, 60.0));
  EXPECT_NEAR(twice.twice, 1.0, 1e-9);
  EXPECT_EQ(twice.half + twice.off_beat, 0.0);
  const BeatLevel between = level_of(beats(0.8, 0.6, 60.0));
  EXPECT_NEAR(between.off_beat, 1.0, 1e-9);
  EXPECT_EQ(between.half + between.twice, 0.0);
}

TEST(BeatLevel, CountsTheTimeAndNotTheBeats) {
  // Half of the time at the double: twice as many beats there, and no more of the time.
  std::vector<double> told_s = beats(0.5, 0.6, 30.0);
  for (const double t : beats(told_s.back() + 0.3, 0.3, 60.0)) told_s.push_back(t);
  EXPECT_NEAR(level_of(told_s).twice, 0.5, 0.02);
}

TEST(BeatLevel, NothingToldIsNotWrong) { EXPECT_EQ(level_of({}).wrong(), 0.0); }

}  // namespace
}  // namespace dance
