#include "producers/music/tracker/tempo/steps_hint.h"

#include <gtest/gtest.h>

namespace dance {
namespace {

constexpr MonoTime kHintBegin = MonoTime::from_us(5'000'000);

Steps steps_of(double tempo_bpm, float weight, bool is_remote = false) {
  Steps steps;
  steps.tempo_bpm = tempo_bpm;
  steps.weight = weight;
  steps.is_remote = is_remote;
  return steps;
}

TEST(StepsHint, IsWhatDancersStepUntilNothingIsHeardOfThem) {
  StepsHint hint;
  EXPECT_EQ(hint.at(kHintBegin).weight, 0.0);
  hint.hear(steps_of(92.0, 1.0f), kHintBegin);
  EXPECT_EQ(hint.at(kHintBegin + Duration::s(1)).tempo_bpm, 92.0);
  EXPECT_GT(hint.at(kHintBegin + Duration::s(1)).weight, 0.5);
  const MonoTime later = kHintBegin + StepsHint::kTimeout + Duration::ms(1);
  EXPECT_EQ(hint.at(later).weight, 0.0);
  hint.hear(steps_of(180.0, 0.5f), later);
  EXPECT_EQ(hint.at(later).tempo_bpm, 180.0);
}

TEST(StepsHint, WeighsLessThanWhatAPersonSays) {
  StepsHint seen;
  seen.hear(steps_of(92.0, 1.0f), kHintBegin);
  EXPECT_LE(seen.at(kHintBegin).weight, StepsHint::kMostWeight);
  StepsHint away;
  away.hear(steps_of(92.0, 1.0f, true), kHintBegin);
  EXPECT_LT(away.at(kHintBegin).weight, seen.at(kHintBegin).weight);
  StepsHint said({96.0, 1.0});
  said.hear(steps_of(192.0, 1.0f), kHintBegin);
  EXPECT_EQ(said.at(kHintBegin).tempo_bpm, 96.0);
  EXPECT_EQ(said.at(kHintBegin).weight, 1.0);
}

TEST(StepsHint, IsNoneOfATempoThatNobodyStepsAt) {
  for (const double bpm : {0.0, 20.0, 399.0}) {
    StepsHint hint;
    hint.hear(steps_of(bpm, 1.0f), kHintBegin);
    EXPECT_EQ(hint.at(kHintBegin).weight, 0.0) << bpm;
  }
}

}  // namespace
}  // namespace dance
