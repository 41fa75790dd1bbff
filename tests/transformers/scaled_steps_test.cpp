// Longer and shorter steps: what stands stays, hips go over it, and nobody is led away.
#include "transformers/style/scaled_steps.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/core/motion/on_its_feet.h"

namespace dance {
namespace {

using Eigen::Quaternionf;
using Eigen::Vector3f;

constexpr float kFramePeriod_s = 1.0f / 60.0f;

void move_foot(BodyFrames& frames, std::size_t side, const Vector3f& by) {
  frames.p_WB_m[ankle_of(side)] += by;
  frames.p_WB_m[ankle_of(side) + 1] += by;
}

// Someone whose hips go on while their feet step after them, `stride_m` a step; every leg is scaled
// by half again.
class Walk {
 public:
  explicit Walk(float stride_m) : stride_m_(stride_m) {}
  // The next pose: one foot a third of a second in the air, the other standing.
  void next(BodyFrames& danced, BodyFrames& scaled) {
    constexpr int kPosesAStep = 20;
    const int step = pose_ / kPosesAStep;
    const float done = static_cast<float>(pose_ % kPosesAStep) / kPosesAStep;
    const float eased = 0.5f - 0.5f * std::cos(3.14159265f * done);
    danced = scaled = on_its_feet();
    const float hips = stride_m_ * (static_cast<float>(step) + done);
    for (std::size_t side = 0; side < 2; ++side) {
      const bool goes = static_cast<std::size_t>(step % 2) == side;
      const float from = stride_m_ * (static_cast<float>(step) + (goes ? -0.5f : 0.5f));
      const float foot = goes ? from + 2.0f * stride_m_ * eased : from;
      const float lift = goes ? 0.1f * std::sin(3.14159265f * done) : 0.0f;
      move_foot(danced, side, {0.0f, lift, foot});
      move_foot(scaled, side, {0.0f, lift, foot + 0.5f * (foot - hips)});
    }
    ++pose_;
  }

 private:
  float stride_m_;
  int pose_ = 0;
};

struct Walked {
  float most_slid_m = 0.0f, most_apart_m = 0.0f, most_hips_m = 0.0f;
  float most_hips_step_m = 0.0f;
};

Walked walk(ScaledSteps& steps, float stride_m, int poses) {
  SwingFeet feet;
  Walk walk(stride_m);
  BodyFrames danced, scaled;
  Walked out;
  ScaledSteps::Aim before{};
  for (int i = 0; i < poses; ++i) {
    walk.next(danced, scaled);
    feet.follow(danced, kFramePeriod_s, i == 0);
    steps.follow(feet, danced, scaled, kFramePeriod_s, false);
    const ScaledSteps::Aim aim = steps.aim(feet, danced, scaled);
    if (i > poses / 2) {
      for (std::size_t side = 0; side < 2; ++side)
        if (feet.swing(side) == 0.0f)
          out.most_slid_m =
              std::max(out.most_slid_m, (aim.p_WAnkle_m[side] - before.p_WAnkle_m[side]).norm());
      const float apart = std::abs((aim.p_WAnkle_m[0] - aim.p_WAnkle_m[1]).z());
      out.most_apart_m = std::max(out.most_apart_m, apart);
      out.most_hips_m = std::max(out.most_hips_m, aim.hips_moved_m.norm());
      out.most_hips_step_m =
          std::max(out.most_hips_step_m, (aim.hips_moved_m - before.hips_moved_m).norm());
    }
    before = aim;
  }
  return out;
}

TEST(ScaledSteps, NobodyIsMovedWhoseLegsAreAsDanced) {
  SwingFeet feet;
  ScaledSteps steps;
  const BodyFrames danced = on_its_feet();
  feet.follow(danced, kFramePeriod_s, true);
  steps.follow(feet, danced, danced, kFramePeriod_s, false);
  EXPECT_TRUE(steps.is_home());
  const ScaledSteps::Aim aim = steps.aim(feet, danced, danced);
  EXPECT_EQ(aim.hips_moved_m, Vector3f::Zero());
  for (std::size_t side = 0; side < 2; ++side)
    EXPECT_LT((aim.p_WAnkle_m[side] - danced.p_WB_m[ankle_of(side)]).norm(), 1e-6f);
}

TEST(ScaledSteps, AStrideIsLongerAndTheFootThatStandsDoesNotMove) {
  ScaledSteps steps;
  const Walked walked = walk(steps, 0.2f, 600);
  // Danced, feet come 0.2 m apart at the most; half again is 0.3 m.
  EXPECT_NEAR(walked.most_apart_m, 0.3f, 0.03f);
  EXPECT_LT(walked.most_slid_m, 1e-5f);
}

TEST(ScaledSteps, WhoWalksOnAndOnIsNotLedAway) {
  ScaledSteps steps;
  const Walked walked = walk(steps, 0.3f, 3600);
  EXPECT_GT(walked.most_hips_m, 0.02f);
  EXPECT_LT(walked.most_hips_m, 0.3f);
  EXPECT_LT(walked.most_hips_step_m, 2.0f * kFramePeriod_s + 1e-5f);
}

TEST(ScaledSteps, HipsGoDownOverBothFeetWhenKneesBendMore) {
  SwingFeet feet;
  ScaledSteps steps;
  const BodyFrames danced = on_its_feet();
  BodyFrames scaled = danced;
  for (std::size_t side = 0; side < 2; ++side) move_foot(scaled, side, {0.0f, 0.05f, 0.0f});
  feet.follow(danced, kFramePeriod_s, true);
  for (int i = 0; i < 60; ++i) {
    feet.follow(danced, kFramePeriod_s, false);
    steps.follow(feet, danced, scaled, kFramePeriod_s, false);
  }
  const ScaledSteps::Aim aim = steps.aim(feet, danced, scaled);
  EXPECT_NEAR(aim.hips_moved_m.y(), -0.05f, 1e-3f);
  for (std::size_t side = 0; side < 2; ++side)
    EXPECT_LT((aim.p_WAnkle_m[side] - danced.p_WB_m[ankle_of(side)]).norm(), 1e-6f);
}

TEST(ScaledSteps, ASoleThatIsFlatIsNotTiltedAndAHeelThatIsUpLiftsHigher) {
  SwingFeet feet;
  ScaledSteps steps;
  BodyFrames danced = on_its_feet();
  feet.follow(danced, kFramePeriod_s, true);
  const Quaternionf tilt(Eigen::AngleAxisf(0.2f, Vector3f::UnitX()));
  BodyFrames scaled = danced;
  scaled.R_WB[ankle_of(0)] = tilt;
  EXPECT_LT(steps.aim(feet, danced, scaled).R_WFoot[0].angularDistance(Quaternionf::Identity()),
            1e-4f);
  danced.p_WB_m[ankle_of(0)].y() += 0.05f;
  scaled.p_WB_m[ankle_of(0)].y() += 0.05f;
  const ScaledSteps::Aim aim = steps.aim(feet, danced, scaled);
  EXPECT_LT(aim.R_WFoot[0].angularDistance(tilt), 1e-4f);
  EXPECT_GT(aim.p_WAnkle_m[0].y(), danced.p_WB_m[ankle_of(0)].y() + 0.015f);
  // Its toes stay on the floor.
  EXPECT_LT(aim.R_WToes[0].angularDistance(Quaternionf::Identity()), 1e-4f);
}

TEST(ScaledSteps, AFootThatIsTiltedOnItsWayDoesNotSnapWhereItMeetsTheFloor) {
  for (const float pitch : {0.3f, -0.3f}) {
    SwingFeet feet;
    ScaledSteps steps;
    BodyFrames danced = on_its_feet();
    feet.follow(danced, kFramePeriod_s, true);
    for (int i = 0; i < 20; ++i) {
      move_foot(danced, 0, {0.0f, 0.0f, 0.02f});
      feet.follow(danced, kFramePeriod_s, false);
    }
    ASSERT_EQ(feet.swing(0), 1.0f);
    move_foot(danced, 0, {0.0f, 0.02f, 0.0f});
    Quaternionf before;
    for (int i = 0; i <= 60; ++i) {
      BodyFrames scaled = danced;
      scaled.R_WB[ankle_of(0)] = Eigen::AngleAxisf(pitch, Vector3f::UnitX());
      // The ball comes down by a millimetre at a time, from above the floor to below it.
      scaled.p_WB_m[ankle_of(0) + 1].y() += 0.01f - 0.001f * static_cast<float>(i);
      const ScaledSteps::Aim aim = steps.aim(feet, danced, scaled);
      EXPECT_TRUE(i == 0 || aim.R_WFoot[0].angularDistance(before) < 0.06f) << pitch << " " << i;
      const Vector3f ball = aim.p_WAnkle_m[0] + aim.R_WFoot[0] * Vector3f(0.0f, -0.06f, 0.12f);
      EXPECT_GT(ball.y(), 0.02f - 1e-4f) << pitch << " " << i;
      EXPECT_GT(aim.p_WAnkle_m[0].y(), 0.08f - 1e-4f) << pitch << " " << i;
      before = aim.R_WFoot[0];
    }
  }
}

TEST(ScaledSteps, NobodyIsPressedDownInTheAir) {
  SwingFeet feet;
  ScaledSteps steps;
  BodyFrames danced = on_its_feet();
  feet.follow(danced, kFramePeriod_s, true);
  for (int i = 0; i < 30; ++i) {
    for (std::size_t side = 0; side < 2; ++side) move_foot(danced, side, {0.0f, 0.02f, 0.02f});
    feet.follow(danced, kFramePeriod_s, false);
    BodyFrames scaled = danced;
    for (std::size_t side = 0; side < 2; ++side) move_foot(scaled, side, {0.0f, 0.25f, 0.0f});
    if (i >= 5) steps.follow(feet, danced, scaled, kFramePeriod_s, false);
    EXPECT_GT(steps.aim(feet, danced, scaled).hips_moved_m.y(), -0.03f) << i;
  }
}

TEST(ScaledSteps, FeetGoHomeWithTheirNextSteps) {
  SwingFeet feet;
  ScaledSteps steps;
  Walk walk(0.2f);
  BodyFrames danced, scaled;
  for (int i = 0; i < 300; ++i) {
    walk.next(danced, scaled);
    feet.follow(danced, kFramePeriod_s, i == 0);
    steps.follow(feet, danced, scaled, kFramePeriod_s, false);
  }
  EXPECT_FALSE(steps.is_home());
  // Who stands does not slide home.
  ScaledSteps waits = steps;
  SwingFeet still = feet;
  for (int i = 0; i < 300; ++i) {
    still.follow(danced, kFramePeriod_s, false);
    waits.follow(still, danced, danced, kFramePeriod_s, true);
  }
  EXPECT_FALSE(waits.is_home());
  int poses = 0;
  for (; poses < 300 && !steps.is_home(); ++poses) {
    walk.next(danced, scaled);
    feet.follow(danced, kFramePeriod_s, false);
    steps.follow(feet, danced, danced, kFramePeriod_s, true);
  }
  EXPECT_LT(poses, 200);
  EXPECT_TRUE(steps.is_home());
}

}  // namespace
}  // namespace dance
