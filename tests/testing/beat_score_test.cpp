#include "testing/music/beat_score.h"

#include <gtest/gtest.h>

namespace dance {
namespace {

TEST(BeatScore, MatchesEachBeatOnce) {
  const std::vector<double> truth{1.0, 2.0, 3.0, 4.0};
  const std::vector<double> told{1.01, 1.02, 2.03, 3.2, 4.0};
  const BeatScore score = score_beats(truth, told, 0.0, 10.0);
  EXPECT_EQ(score.hits, 3);
  EXPECT_NEAR(score.f_measure(), 6.0 / 9.0, 1e-12);
  EXPECT_NEAR(score.mean_error_s, 0.04 / 3.0, 1e-9);
}

TEST(BeatScore, OfTwiceTheTempoIsTwoThirds) {
  std::vector<double> truth, told;
  for (int i = 0; i < 100; ++i) truth.push_back(i);
  for (int i = 0; i < 200; ++i) told.push_back(0.5 * i);
  EXPECT_NEAR(score_beats(truth, told, 0.0, 100.0).f_measure(), 2.0 / 3.0, 1e-9);
}

TEST(BeatScore, LeavesOutTheBegin) {
  const std::vector<double> truth{1.0, 6.0};
  const std::vector<double> told{6.05};
  EXPECT_EQ(score_beats(truth, told, 5.0, 10.0).f_measure(), 1.0);
  EXPECT_EQ(score_beats({}, {}, 0.0, 1.0).f_measure(), 0.0);
}

Beat word(double now_s, double next_s, double number) {
  Beat beat;
  beat.time = MonoTime{} + Duration::seconds(now_s);
  beat.beat_time = MonoTime{} + Duration::seconds(next_s);
  beat.beat = number;
  beat.tempo_bpm = 120.0;
  beat.playing = true;
  return beat;
}

TEST(PredictedBeats, CountsWhatWasSaidAHopBefore) {
  PredictedBeats beats(0.01);
  beats.hear(word(1.00, 1.50, 0));
  beats.hear(word(1.48, 1.51, 0));
  beats.hear(word(1.505, 1.508, 0));  // too late to be of use
  beats.hear(word(1.515, 2.01, 1));
  ASSERT_EQ(beats.times_s().size(), 1u);
  EXPECT_NEAR(beats.times_s()[0], 1.51, 1e-9);
}

TEST(PredictedBeats, ForgetsABeatThatNobodyWasToldInTime) {
  PredictedBeats beats(0.01);
  beats.hear(word(1.00, 1.005, 0));
  beats.hear(word(1.01, 1.50, 1));
  beats.hear(word(1.51, 2.0, 2));
  ASSERT_EQ(beats.times_s().size(), 1u);
  EXPECT_NEAR(beats.times_s()[0], 1.5, 1e-9);
}

}  // namespace
}  // namespace dance
