// Made takes of somebody who stands about: a body whose feet stand.
#include "research/trackers/standing_take.h"

#include <gtest/gtest.h>

#include "core/pose/kinematics.h"

namespace dance {
namespace {

PredictTake take_of(std::uint64_t seed) {
  Random random(seed);
  return standing_take(1.74f, 60.0, 60.0, random);
}

TEST(StandingTake, IsABodyOnTheFloorWithFeetThatStandAndStep) {
  const PredictTake take = take_of(7);
  ASSERT_EQ(take.poses.size(), 3600u);
  BodyFrames before, frames;
  float lowest = 1.0f, highest = 0.0f;
  int both_still = 0, steps = 0;
  bool was_stepping = false;
  for (std::size_t i = 0; i < take.poses.size(); ++i) {
    ASSERT_TRUE(is_valid(take.poses[i])) << i;
    forward_kinematics(take.skeleton, take.poses[i], frames);
    lowest = std::min(
        {lowest, frames.position(Bone::kLeftFoot).y(), frames.position(Bone::kRightFoot).y()});
    highest = std::max(highest, frames.position(Bone::kLeftFoot).y());
    if (i > 0) {
      const float left =
          (frames.position(Bone::kLeftFoot) - before.position(Bone::kLeftFoot)).norm();
      const float right =
          (frames.position(Bone::kRightFoot) - before.position(Bone::kRightFoot)).norm();
      // One foot at a time, and none at most times.
      EXPECT_LT(std::min(left, right), 0.008f) << i;
      both_still += left < 1e-3f && right < 1e-3f;
      const bool is_stepping = std::max(left, right) > 0.01f;
      steps += is_stepping && !was_stepping;
      was_stepping = is_stepping;
      EXPECT_LT((take.poses[i].p_WH_m - take.poses[i - 1].p_WH_m).norm(), 0.05f) << i;
    }
    before = frames;
  }
  EXPECT_GT(lowest, 0.05f) << "ankles are above the floor";
  EXPECT_GT(highest, lowest + 0.02f) << "feet are lifted";
  EXPECT_GT(both_still, 1800);
  EXPECT_GT(steps, 10);
}

TEST(StandingTake, IsTheSameOfTheSameNumbersAndAnotherOfOthers) {
  const PredictTake a = take_of(3), b = take_of(3), c = take_of(4);
  EXPECT_EQ(a.poses[900].p_WH_m, b.poses[900].p_WH_m);
  EXPECT_NE(a.poses[900].p_WH_m, c.poses[900].p_WH_m);
}

}  // namespace
}  // namespace dance
