#include "transformers/predict/guess_guard.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

namespace dance {
namespace {

constexpr std::size_t kGuarded = 2;  // a horizon

std::array<float, kRowGroups> half_metres() {
  std::array<float, kRowGroups> lever;
  lever.fill(0.5f);
  return lever;
}

BodyRow everywhere(float value) {
  BodyRow row;
  row.v.fill(value);
  return row;
}

// A dancer who was seen to stand, and of whom it is guessed that each bone turns by `guess`.
std::unique_ptr<MomentGuesses> guess_of(float guess) {
  auto guesses = std::make_unique<MomentGuesses>();
  for (BodyRow& row : guesses->common) row = everywhere(0.0f);
  for (BodyRow& row : guesses->blended) row = everywhere(guess);
  return guesses;
}

class GuessGuards : public ::testing::Test {
 protected:
  void moments(int count, std::size_t horizon, const MomentGuesses& guesses, const BodyRow& way) {
    for (int i = 0; i < count; ++i) guard_.learn(horizon, guesses, way);
  }
  BodyRow shown(std::size_t horizon, const MomentGuesses& guesses) const {
    BodyRow way;
    guard_.finish(horizon, guesses, way);
    return way;
  }

  GuessGuard guard_{half_metres()};
};

TEST_F(GuessGuards, GiveWayToStandingStillWhereThatWasBetter) {
  const auto guesses = guess_of(0.3f);
  EXPECT_GT(shown(kGuarded, *guesses).v[0], 0.15f) << "little is known against it";
  moments(60, kGuarded, *guesses, everywhere(0.0f));
  EXPECT_LT(shown(kGuarded, *guesses).v[0], 0.02f);
  moments(300, kGuarded, *guesses, everywhere(0.3f));
  EXPECT_NEAR(shown(kGuarded, *guesses).v[0], 0.3f, 0.015f) << "it is right again";
}

TEST_F(GuessGuards, GoOnWhereThatWasBetter) {
  auto guesses = guess_of(-0.2f);
  const float rows = static_cast<float>(kHorizonFrames[kGuarded]);
  guesses->common[static_cast<std::size_t>(Guess::kSlope1)] = everywhere(0.3f / rows);
  moments(120, kGuarded, *guesses, everywhere(0.3f));
  EXPECT_NEAR(shown(kGuarded, *guesses).v[0], 0.3f, 0.03f);
}

TEST_F(GuessGuards, JudgeABoneByItselfAndALittleByTheBody) {
  const auto guesses = guess_of(0.1f);
  constexpr std::size_t kRight = index_of(Bone::kLeftHand), kWrong = index_of(Bone::kRightHand);
  BodyRow way = everywhere(0.1f);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    guesses->blended[kGuarded](kWrong, axis) = 1.0f;
    way(kWrong, axis) = 0.0f;
  }
  moments(120, kGuarded, *guesses, way);
  const BodyRow now = shown(kGuarded, *guesses);
  EXPECT_GT(now(kRight, 1), 0.09f);
  EXPECT_LT(now(kWrong, 1), 0.1f);
}

TEST_F(GuessGuards, JudgeTheHipsPlaceByItself) {
  // The joints are guessed well, and best by standing still; the hips go on, which is guessed
  // badly.
  auto guesses = guess_of(0.0f);
  const float rows = static_cast<float>(kHorizonFrames[kGuarded]);
  guesses->common[static_cast<std::size_t>(Guess::kSlope1)] = everywhere(0.01f);
  BodyRow way = everywhere(0.0f);
  for (std::size_t axis = 0; axis < 3; ++axis) way(kPlaceGroup, axis) = 0.01f * rows;
  moments(120, kGuarded, *guesses, way);
  const BodyRow now = shown(kGuarded, *guesses);
  EXPECT_NEAR(now(kPlaceGroup, 0), 0.01f * rows, 0.001f);
  EXPECT_NEAR(now(index_of(Bone::kLeftHand), 0), 0.0f, 0.002f);
}

// Nothing jumps: from one moment to the next what is shown moves a part of the way between the
// guesses.
TEST_F(GuessGuards, LeanWithoutASwitch) {
  const auto guesses = guess_of(0.3f);
  moments(90, kGuarded, *guesses, everywhere(0.3f));
  float before = shown(kGuarded, *guesses).v[0], steepest = 0.0f;
  for (int i = 0; i < 90; ++i) {
    moments(1, kGuarded, *guesses, everywhere(0.0f));
    const float now = shown(kGuarded, *guesses).v[0];
    steepest = std::max(steepest, std::abs(now - before));
    before = now;
  }
  EXPECT_LT(before, 0.03f);
  EXPECT_LT(steepest, 0.1f);
}

TEST_F(GuessGuards, DoNotWaitForASecondWhereTheNearerGuessesAreWrong) {
  const auto guesses = guess_of(0.3f);
  const auto right_at_times = [&](std::size_t horizon) {
    moments(1, horizon, *guesses, everywhere(0.4f));
    moments(1, horizon, *guesses, everywhere(0.0f));
  };
  for (int i = 0; i < 30; ++i) right_at_times(7);
  const float before = shown(7, *guesses).v[0];
  const float nearer = shown(3, *guesses).v[0];
  moments(60, 5, *guesses, everywhere(0.0f));
  right_at_times(7);
  EXPECT_LT(shown(7, *guesses).v[0], 0.8f * before);
  EXPECT_EQ(shown(3, *guesses).v[0], nearer) << "what is nearer than that is not concerned";
}

// A limb that a sensor loses for a frame is eleven radians away from where anyone would have
// guessed it.
TEST_F(GuessGuards, DoNotLetAFrameOfNonsenseOutweighADance) {
  constexpr std::size_t kLost = index_of(Bone::kLeftUpperLeg);
  auto guesses = guess_of(0.0f);
  const float rows = static_cast<float>(kHorizonFrames[kGuarded]);
  BodyRow& slope = guesses->common[static_cast<std::size_t>(Guess::kSlope1)];
  slope = everywhere(0.05f / rows);
  moments(120, kGuarded, *guesses, everywhere(0.05f));
  auto nonsense = guess_of(0.0f);
  BodyRow& jump = nonsense->common[static_cast<std::size_t>(Guess::kSlope1)];
  jump = slope;
  for (std::size_t axis = 0; axis < 3; ++axis) jump(kLost, axis) = 11.0f / rows;
  moments(2, kGuarded, *nonsense, everywhere(0.05f));
  moments(15, kGuarded, *guesses, everywhere(0.05f));
  const BodyRow now = shown(kGuarded, *guesses);
  EXPECT_GT(now(kLost, 0), 0.04f);
  EXPECT_GT(now(index_of(Bone::kRightHand), 0), 0.045f);
}

TEST_F(GuessGuards, KeepWhatIsKnownForLongOverAGap) {
  const auto guesses = guess_of(0.3f);
  moments(120, kGuarded, *guesses, everywhere(0.0f));
  guard_.forget_lately();
  EXPECT_LT(shown(kGuarded, *guesses).v[0], 0.05f);
  guard_.clear();
  EXPECT_GT(shown(kGuarded, *guesses).v[0], 0.15f) << "another dancer";
}

TEST_F(GuessGuards, StayFiniteWithABodyLikeStone) {
  const auto guesses = guess_of(0.0f);
  moments(500, kGuarded, *guesses, everywhere(0.0f));
  for (const float v : shown(kGuarded, *guesses).v) EXPECT_EQ(v, 0.0f);
}

}  // namespace
}  // namespace dance
