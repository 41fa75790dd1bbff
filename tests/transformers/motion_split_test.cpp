// What comes again with each bar, told apart from the rest: how soon it follows, and that it never
// runs away.
#include "transformers/style/motion_split.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/random.h"
#include "core/motion/rotation_vector.h"

namespace dance {
namespace {

constexpr std::size_t kSplitArm = index_of(Bone::kLeftUpperArm);
constexpr double kTurn = 2.0 * std::numbers::pi;

// An arm that swings, pose by pose.
class SwingingArm {
 public:
  // The arm at `angle_rad`, at a position of the music, dt_s after the one before: what of it is
  // periodic.
  float show(double angle_rad, double bars, double dt_s) {
    Pose pose;
    pose.R_PB[kSplitArm] = exp_rotation(Eigen::Vector3f(0.0f, 0.0f, static_cast<float>(angle_rad)));
    BodyFrames frames;
    forward_kinematics(skeleton_, pose, frames);
    split_.split(pose, frames, bars, parts_);
    split_.learn(parts_, bars, dt_s);
    return parts_.periodic.turn[kSplitArm].z();
  }
  float rest() const { return parts_.rest.turn[kSplitArm].z(); }

 private:
  Skeleton skeleton_ = average_skeleton();
  MotionSplit split_;
  MotionSplit::Parts parts_;
};

// Through bars of two seconds.
template <class Look>
double swing_for(SwingingArm& arm, double from_bars, double length_bars, double size_rad,
                 const Look& look) {
  constexpr double kStep_s = 1.0 / 60.0, kBar_s = 2.0;
  double bars = from_bars;
  for (; bars < from_bars + length_bars; bars += kStep_s / kBar_s) {
    const double angle = size_rad * std::sin(kTurn * bars);
    look(arm.show(angle, bars, kStep_s), static_cast<float>(angle));
  }
  return bars;
}

constexpr auto kLooksAway = [](float, float) {};

TEST(MotionSplit, AtTheBeginNothingIsShownLargerThanItIs) {
  SwingingArm arm;
  float most = 0.0f;
  (void)swing_for(arm, 0.3, 10.0, 0.3,
                  [&](float periodic, float) { most = std::max(most, std::abs(periodic)); });
  EXPECT_GT(most, 0.29f);
  EXPECT_LT(most, 0.31f);
}

TEST(MotionSplit, AChangeOfTheDanceIsFollowedWithinTwoBars) {
  SwingingArm arm;
  double bars = swing_for(arm, 0.0, 10.0, 0.2, kLooksAway);
  bars = swing_for(arm, bars, 2.0, 0.4, kLooksAway);
  float missed = 0.0f;
  (void)swing_for(arm, bars, 1.0, 0.4, [&](float periodic, float angle) {
    missed = std::max(missed, std::abs(angle - periodic));
  });
  EXPECT_LT(missed, 0.03f);  // of the 0.2 that it changed by
}

TEST(MotionSplit, WhoStandsStillHasNothingPeriodicSoonAfter) {
  SwingingArm arm;
  double bars = swing_for(arm, 0.0, 10.0, 0.4, kLooksAway);
  bars = swing_for(arm, bars, 4.0, 0.0, kLooksAway);
  (void)swing_for(arm, bars, 1.0, 0.0,
                  [](float periodic, float) { ASSERT_LT(std::abs(periodic), 0.02f); });
}

// Fewer poses than a camera ever sends, fast music, and nothing but chance: what is missed counts
// again, and must not feed itself.
TEST(MotionSplit, NoiseAtFewPosesNeverRunsAway) {
  for (const double hz : {10.0, 15.0, 30.0}) {
    Random random(3);
    SwingingArm arm;
    double bars = 0.0, late = 0.0;
    std::size_t poses = 0;
    for (double t = 0.0; t < 300.0; t += 1.0 / hz) {
      bars += 0.9 / hz;
      const float periodic = arm.show(random.uniform(-0.3, 0.3), bars, 1.0 / hz);
      ASSERT_LT(std::abs(periodic), 1.0f) << hz << " " << t;
      if (t < 200.0) continue;
      late += static_cast<double>(periodic) * static_cast<double>(periodic);
      ++poses;
    }
    EXPECT_LT(std::sqrt(late / static_cast<double>(poses)), 0.3) << hz;
  }
}

TEST(MotionSplit, MusicThatGetsFasterKeepsTheBarsPart) {
  SwingingArm arm;
  double bars = swing_for(arm, 0.0, 10.0, 0.3, kLooksAway);
  for (double t = 0.0; t < 12.0; t += 1.0 / 60.0) {
    bars += (0.5 + 0.02 * t) / 60.0;  // half as fast again after twelve seconds
    const double angle = 0.3 * std::sin(kTurn * bars);
    ASSERT_NEAR(arm.show(angle, bars, 1.0 / 60.0), angle, 0.02) << t;
  }
}

TEST(MotionSplit, WithoutMusicAllIsRestAndAnotherPlaceOfTheMusicBeginsAnew) {
  SwingingArm arm;
  double bars = swing_for(arm, 0.0, 10.0, 0.3, kLooksAway);
  for (int i = 0; i < 60; ++i) {
    ASSERT_EQ(arm.show(0.2, kNoMusic, 1.0 / 60.0), 0.0f);
    ASSERT_GT(arm.rest(), 0.1f);
  }
  bars = swing_for(arm, bars, 3.0, 0.3, kLooksAway);
  // Somewhere else in the music, the swing the other way round: what was learnt there is not shown
  // here.
  (void)swing_for(arm, bars + 0.5, 0.1, 0.3, kLooksAway);
  float missed = 0.0f;
  (void)swing_for(arm, bars + 0.6, 0.8, -0.3,
                  [&](float periodic, float) { missed = std::max(missed, std::abs(periodic)); });
  EXPECT_LT(missed, 0.01f);
}

}  // namespace
}  // namespace dance
