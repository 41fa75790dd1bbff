#include "transformers/predict/blend/prediction_guard.h"

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

// A dancer who was seen to stand, and of whom it is predicted that each bone turns by `prediction`.
std::unique_ptr<MomentPredictions> prediction_of(float prediction) {
  auto predictions = std::make_unique<MomentPredictions>();
  for (BodyRow& row : predictions->common) row = everywhere(0.0f);
  for (BodyRow& row : predictions->blended) row = everywhere(prediction);
  return predictions;
}

class PredictionGuards : public ::testing::Test {
 protected:
  void moments(int count, std::size_t horizon, const MomentPredictions& predictions,
               const BodyRow& way) {
    for (int i = 0; i < count; ++i) guard_.learn(horizon, predictions, way);
  }
  BodyRow shown(std::size_t horizon, const MomentPredictions& predictions) const {
    BodyRow way;
    guard_.finish(horizon, predictions, way);
    return way;
  }

  PredictionGuard guard_{half_metres()};
};

TEST_F(PredictionGuards, GiveWayToStandingStillWhereThatWasBetter) {
  const auto predictions = prediction_of(0.3f);
  EXPECT_GT(shown(kGuarded, *predictions).v[0], 0.15f) << "little is known against it";
  moments(60, kGuarded, *predictions, everywhere(0.0f));
  EXPECT_LT(shown(kGuarded, *predictions).v[0], 0.02f);
  moments(300, kGuarded, *predictions, everywhere(0.3f));
  EXPECT_NEAR(shown(kGuarded, *predictions).v[0], 0.3f, 0.015f) << "it is right again";
}

TEST_F(PredictionGuards, GoOnWhereThatWasBetter) {
  auto predictions = prediction_of(-0.2f);
  const float rows = static_cast<float>(kHorizonFrames[kGuarded]);
  predictions->common[static_cast<std::size_t>(Prediction::kSlope1)] = everywhere(0.3f / rows);
  moments(120, kGuarded, *predictions, everywhere(0.3f));
  EXPECT_NEAR(shown(kGuarded, *predictions).v[0], 0.3f, 0.03f);
}

TEST_F(PredictionGuards, JudgeABoneByItselfAndALittleByTheBody) {
  const auto predictions = prediction_of(0.1f);
  constexpr std::size_t kRight = index_of(Bone::kLeftHand), kWrong = index_of(Bone::kRightHand);
  BodyRow way = everywhere(0.1f);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    predictions->blended[kGuarded](kWrong, axis) = 1.0f;
    way(kWrong, axis) = 0.0f;
  }
  moments(120, kGuarded, *predictions, way);
  const BodyRow now = shown(kGuarded, *predictions);
  EXPECT_GT(now(kRight, 1), 0.09f);
  EXPECT_LT(now(kWrong, 1), 0.1f);
}

TEST_F(PredictionGuards, JudgeTheHipsPlaceByItself) {
  // The joints are predicted well, and best by standing still; the hips go on, which is predicted
  // badly.
  auto predictions = prediction_of(0.0f);
  const float rows = static_cast<float>(kHorizonFrames[kGuarded]);
  predictions->common[static_cast<std::size_t>(Prediction::kSlope1)] = everywhere(0.01f);
  BodyRow way = everywhere(0.0f);
  for (std::size_t axis = 0; axis < 3; ++axis) way(kPlaceGroup, axis) = 0.01f * rows;
  moments(120, kGuarded, *predictions, way);
  const BodyRow now = shown(kGuarded, *predictions);
  EXPECT_NEAR(now(kPlaceGroup, 0), 0.01f * rows, 0.001f);
  EXPECT_NEAR(now(index_of(Bone::kLeftHand), 0), 0.0f, 0.002f);
}

// Nothing jumps: from one moment to the next what is shown moves a part of the way between the
// predictions.
TEST_F(PredictionGuards, LeanWithoutASwitch) {
  const auto predictions = prediction_of(0.3f);
  moments(90, kGuarded, *predictions, everywhere(0.3f));
  float before = shown(kGuarded, *predictions).v[0], steepest = 0.0f;
  for (int i = 0; i < 90; ++i) {
    moments(1, kGuarded, *predictions, everywhere(0.0f));
    const float now = shown(kGuarded, *predictions).v[0];
    steepest = std::max(steepest, std::abs(now - before));
    before = now;
  }
  EXPECT_LT(before, 0.03f);
  EXPECT_LT(steepest, 0.1f);
}

TEST_F(PredictionGuards, DoNotWaitForASecondWhereTheNearerPredictionsAreWrong) {
  const auto predictions = prediction_of(0.3f);
  const auto right_at_times = [&](std::size_t horizon) {
    moments(1, horizon, *predictions, everywhere(0.4f));
    moments(1, horizon, *predictions, everywhere(0.0f));
  };
  for (int i = 0; i < 30; ++i) right_at_times(7);
  const float before = shown(7, *predictions).v[0];
  const float nearer = shown(3, *predictions).v[0];
  moments(60, 5, *predictions, everywhere(0.0f));
  right_at_times(7);
  EXPECT_LT(shown(7, *predictions).v[0], 0.8f * before);
  EXPECT_EQ(shown(3, *predictions).v[0], nearer) << "what is nearer than that is not concerned";
}

// A limb that a sensor loses for a frame is eleven radians away from where anyone would have
// predicted it.
TEST_F(PredictionGuards, DoNotLetAFrameOfNonsenseOutweighADance) {
  constexpr std::size_t kLost = index_of(Bone::kLeftUpperLeg);
  auto predictions = prediction_of(0.0f);
  const float rows = static_cast<float>(kHorizonFrames[kGuarded]);
  BodyRow& slope = predictions->common[static_cast<std::size_t>(Prediction::kSlope1)];
  slope = everywhere(0.05f / rows);
  moments(120, kGuarded, *predictions, everywhere(0.05f));
  auto nonsense = prediction_of(0.0f);
  BodyRow& jump = nonsense->common[static_cast<std::size_t>(Prediction::kSlope1)];
  jump = slope;
  for (std::size_t axis = 0; axis < 3; ++axis) jump(kLost, axis) = 11.0f / rows;
  moments(2, kGuarded, *nonsense, everywhere(0.05f));
  moments(15, kGuarded, *predictions, everywhere(0.05f));
  const BodyRow now = shown(kGuarded, *predictions);
  EXPECT_GT(now(kLost, 0), 0.04f);
  EXPECT_GT(now(index_of(Bone::kRightHand), 0), 0.045f);
}

TEST_F(PredictionGuards, KeepWhatIsKnownForLongOverAGap) {
  const auto predictions = prediction_of(0.3f);
  moments(120, kGuarded, *predictions, everywhere(0.0f));
  guard_.forget_lately();
  EXPECT_LT(shown(kGuarded, *predictions).v[0], 0.05f);
  guard_.clear();
  EXPECT_GT(shown(kGuarded, *predictions).v[0], 0.15f) << "another dancer";
}

TEST_F(PredictionGuards, StayFiniteWithABodyLikeStone) {
  const auto predictions = prediction_of(0.0f);
  moments(500, kGuarded, *predictions, everywhere(0.0f));
  for (const float v : shown(kGuarded, *predictions).v) EXPECT_EQ(v, 0.0f);
}

}  // namespace
}  // namespace dance
