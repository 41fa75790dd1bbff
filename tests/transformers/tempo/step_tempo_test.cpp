#include "transformers/tempo/step_tempo.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace dance {
namespace {

constexpr Duration kTurn = Duration::ms(100);

void dance(StepTempo& steps, const std::vector<double>& tempi_bpm, double seconds,
           float coherence = 0.9f) {
  for (double s = 0.0; s < seconds; s += kTurn.as_seconds()) {
    for (const double bpm : tempi_bpm) steps.see(bpm, coherence);
    steps.pass(kTurn);
  }
}

TEST(StepTempo, IsThatOfTheDancersOnceTheyAreKnown) {
  StepTempo steps;
  EXPECT_EQ(steps.weight(), 0.0);
  dance(steps, {96.0}, 1.0);
  EXPECT_LT(steps.weight(), 0.3);
  dance(steps, {95.0, 97.0}, 15.0);
  EXPECT_NEAR(steps.tempo_bpm(), 96.0, 2.0);
  EXPECT_GT(steps.weight(), 0.9);
}

TEST(StepTempo, WeighsNothingWhereDancersStepAtTwoLevels) {
  StepTempo steps;
  dance(steps, {96.0, 192.0}, 20.0);
  EXPECT_LT(steps.weight(), 0.2);
  dance(steps, {96.0, 96.0, 96.0, 192.0}, 60.0);
  EXPECT_NEAR(steps.tempo_bpm(), 96.0, 2.0);
  EXPECT_GT(steps.weight(), 0.4);
  EXPECT_LT(steps.weight(), 0.6);
}

TEST(StepTempo, FollowsAnotherDance) {
  StepTempo steps;
  dance(steps, {96.0}, 30.0);
  dance(steps, {180.0}, 60.0);
  EXPECT_NEAR(steps.tempo_bpm(), 180.0, 4.0);
  EXPECT_GT(steps.weight(), 0.7);
}

TEST(StepTempo, IsForgottenWhenNobodyDances) {
  StepTempo steps;
  dance(steps, {120.0}, 30.0);
  dance(steps, {}, 100.0);
  EXPECT_LT(steps.weight(), 0.1);
}

TEST(StepTempo, PassesOverWhatIsNoDance) {
  StepTempo steps;
  dance(steps, {0.0, -5.0, 1e9, std::nan("")}, 10.0);
  dance(steps, {120.0}, 10.0, 0.1f);
  dance(steps, {120.0}, 10.0, std::nanf(""));
  EXPECT_EQ(steps.weight(), 0.0);
}

}  // namespace
}  // namespace dance
