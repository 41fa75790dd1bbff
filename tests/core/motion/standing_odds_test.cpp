#include "core/motion/standing_odds.h"

#include <gtest/gtest.h>

#include <cmath>

namespace dance {
namespace {

// A foot on the floor under the hips, beside one that stands half a metre from it.
class StandingOdds : public ::testing::Test {
 protected:
  float odds(float came_m, float goes_m, float above_m) const {
    FootView moved = foot_;
    moved.there.y() += above_m;
    moved.before = moved.there - Eigen::Vector3f(came_m, 0.0f, 0.0f);
    moved.after = moved.there + Eigen::Vector3f(0.0f, 0.0f, goes_m);
    return standing_log_odds(moved, other_, hips_, foot_.there.y());
  }
  static FootView resting_at(const Eigen::Vector3f& at) { return {at, at, at, at, 0.0f, 0.3f}; }

  FootView foot_ = resting_at({0.1f, 0.02f, 0.3f});
  FootView other_ = resting_at({-0.1f, 0.02f, -0.1f});
  HipsView hips_{{0.05f, 0.9f, 0.2f}, {0.05f, 0.9f, 0.2f}, 0.2f};
};

TEST_F(StandingOdds, AreHighOfAFootThatRestsOnTheFloorAndLowOfOneThatStepsOrFloats) {
  const float rests = odds(0.0f, 0.0f, 0.0f);
  EXPECT_GT(rests, 1.5f);
  // At 1.5 m/s; one that lands is not as far from standing.
  EXPECT_LT(odds(0.1f, 0.1f, 0.03f), rests - 2.5f);
  EXPECT_GT(odds(0.1f, 0.0f, 0.0f), odds(0.1f, 0.1f, 0.0f));
  EXPECT_LT(odds(0.0f, 0.0f, 0.15f), rests - 2.5f);
}

TEST_F(StandingOdds, AreHigherOfTheFootThatCarriesAndOfOneBesideAFootThatSwings) {
  const float before = odds(0.0f, 0.0f, 0.0f);
  other_.there.y() += 0.1f;
  other_.after.y() += 0.1f;
  EXPECT_GT(odds(0.0f, 0.0f, 0.0f), before + 0.5f);
  other_ = resting_at({-0.1f, 0.02f, -0.1f});
  hips_.there = hips_.seen = {-0.1f, 0.9f, -0.1f};
  EXPECT_LT(odds(0.0f, 0.0f, 0.0f), before - 0.5f) << "the hips are over the other foot";
}

TEST_F(StandingOdds, AreLowerOfAFootThatWasSeenInSwingAndWhereTheHipsTravel) {
  const float before = odds(0.0f, 0.0f, 0.0f);
  foot_.seen_speed_m_s = 1.5f;
  EXPECT_LT(odds(0.0f, 0.0f, 0.0f), before - 1.0f);
  foot_.seen_speed_m_s = 0.0f;
  hips_.seen.x() -= 0.2f;
  EXPECT_LT(odds(0.0f, 0.0f, 0.0f), before - 0.5f);
}

TEST_F(StandingOdds, AreNothingKnownWhereAPlaceIsNotFinite) {
  other_.seen.x() = std::nanf("");
  EXPECT_FALSE(std::isfinite(odds(0.0f, 0.0f, 0.0f)));
}

}  // namespace
}  // namespace dance
