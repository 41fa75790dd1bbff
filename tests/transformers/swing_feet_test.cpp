// Which foot is on its way, and the mean that is kept.
#include "transformers/style/swing_feet.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/core/motion/on_its_feet.h"
#include "transformers/style/kept_mean.h"

namespace dance {
namespace {

using Eigen::Vector3f;

void move_left(BodyFrames& frames, const Vector3f& ankle_by, const Vector3f& ball_by) {
  frames.p_WB_m[index_of(Bone::kLeftFoot)] += ankle_by;
  frames.p_WB_m[index_of(Bone::kLeftToes)] += ball_by;
}

TEST(SwingFeet, AStepSwingsTheFootThatGoesAndIsOverWhenItLandsAtAnyRateOfPoses) {
  for (const float hz : {30.0f, 60.0f, 120.0f}) {
    SwingFeet feet;
    BodyFrames frames = on_its_feet();
    feet.follow(frames, 1.0f / 60.0f, true);
    EXPECT_EQ(feet.swing(0), 0.0f);
    float most = 0.0f, landed = 1.0f;
    for (float t = 0.0f; t < 0.6f; t += 1.0f / hz) {
      // A third of a second at up to two metres a second.
      const float speed = t < 0.33f ? 2.0f * std::sin(9.52f * t) : 0.0f;
      move_left(frames, speed / hz * Vector3f::UnitX(), speed / hz * Vector3f::UnitX());
      feet.follow(frames, 1.0f / hz, false);
      most = std::max(most, feet.swing(0));
      if (t > 0.4f) landed = std::min(landed, feet.swing(0));
      ASSERT_EQ(feet.swing(1), 0.0f);
    }
    EXPECT_EQ(most, 1.0f) << hz;
    EXPECT_EQ(landed, 0.0f) << hz;
  }
}

TEST(SwingFeet, AFootThatTurnsOnItsBallOrItsHeelStands) {
  SwingFeet feet;
  BodyFrames frames = on_its_feet();
  feet.follow(frames, 1.0f / 60.0f, true);
  for (int i = 0; i < 20; ++i) {
    move_left(frames, 0.03f * Vector3f::UnitX(), Vector3f::Zero());
    feet.follow(frames, 1.0f / 60.0f, false);
    ASSERT_EQ(feet.swing(0), 0.0f);
  }
  for (int i = 0; i < 20; ++i) feet.follow(frames, 1.0f / 60.0f, false);
  for (int i = 0; i < 20; ++i) {
    move_left(frames, Vector3f::Zero(), 0.03f * Vector3f::UnitX());
    feet.follow(frames, 1.0f / 60.0f, false);
    ASSERT_EQ(feet.swing(0), 0.0f);
  }
}

TEST(SwingFeet, AFootMayBeAsLowAsTheFloorOrAsItWasDanced) {
  SwingFeet feet;
  const BodyFrames danced = on_its_feet();
  feet.follow(danced, 1.0f / 60.0f, true);
  BodyFrames up = danced, down = danced;
  move_left(up, 0.03f * Vector3f::UnitY(), 0.03f * Vector3f::UnitY());
  move_left(down, -0.03f * Vector3f::UnitY(), -0.03f * Vector3f::UnitY());
  EXPECT_FLOAT_EQ(feet.lowest_ankle_m(0, up), 0.08f);
  EXPECT_FLOAT_EQ(feet.lowest_ball_m(0, up), 0.02f);
  EXPECT_NEAR(feet.lowest_ankle_m(0, down), 0.05f, 1e-6f);
  EXPECT_NEAR(feet.lowest_ball_m(0, down), -0.01f, 1e-6f);
  EXPECT_NEAR(feet.heel_m(0, up), 0.03f, 1e-6f);
}

TEST(SwingFeet, AHigherFloorIsLearntWithinSeconds) {
  SwingFeet feet;
  BodyFrames frames = on_its_feet();
  feet.follow(frames, 1.0f / 60.0f, true);
  move_left(frames, 0.1f * Vector3f::UnitY(), 0.1f * Vector3f::UnitY());
  for (int i = 0; i < 600; ++i) feet.follow(frames, 1.0f / 60.0f, false);
  EXPECT_NEAR(feet.lowest_ankle_m(0, frames), 0.18f, 1e-3f);
  EXPECT_NEAR(feet.lowest_ball_m(0, frames), 0.12f, 1e-3f);
}

TEST(KeptMean, WhatDriftsIsTakenOffWithoutLag) {
  KeptMean mean;
  for (int i = 1; i <= 1000; ++i)
    mean.follow(Vector3f::Constant(0.01f * static_cast<float>(i)), 0.01f);
  EXPECT_NEAR(mean.value().x(), 10.0f, 0.03f);
  EXPECT_NEAR(mean.once.x(), 9.0f, 0.03f);  // one average alone is behind
}

TEST(KeptMean, AStepIsComeToAndHardlyPassed) {
  KeptMean mean;
  float most = 0.0f;
  for (int i = 0; i < 1200; ++i) {
    mean.follow(Vector3f::Ones(), 0.01f);
    most = std::max(most, mean.value().x());
  }
  EXPECT_LT(most, 1.14f);
  EXPECT_NEAR(mean.value().x(), 1.0f, 1e-3f);
}

}  // namespace
}  // namespace dance
