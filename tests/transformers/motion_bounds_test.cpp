#include "transformers/predict/past/motion_bounds.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "transformers/predict/model/body_net.h"

namespace dance {
namespace {

float size_of(const BodyRow& row, std::size_t group) {
  return std::sqrt(row(group, 0) * row(group, 0) + row(group, 1) * row(group, 1) +
                   row(group, 2) * row(group, 2));
}

TEST(MotionBounds, LeaveADanceAsItIs) {
  BodyRow way;
  way.v.fill(0.25f);
  const BodyRow was = way;
  EXPECT_TRUE(bound_motion(0, way));
  EXPECT_EQ(way.v, was.v);
  BodyRow slope;
  slope.v.fill(0.05f);
  const BodyRow went = slope;
  bound_slope(slope);
  EXPECT_EQ(slope.v, went.v);
}

TEST(MotionBounds, ShortenImplausibleMotionAndKeepItsDirection) {
  constexpr std::size_t kLeg = index_of(Bone::kLeftUpperLeg), kHand = index_of(Bone::kRightHand);
  BodyRow way;
  way(kLeg, 0) = 3.0f;
  way(kLeg, 2) = -4.0f;
  way(kHand, 1) = 0.1f;
  way(kPlaceGroup, 0) = 40.0f;
  EXPECT_TRUE(bound_motion(0, way));
  EXPECT_NEAR(size_of(way, kLeg), 1.0f, 1e-4f) << "0.2 and 16 a second for 50 ms";
  EXPECT_NEAR(way(kLeg, 0) / way(kLeg, 2), -0.75f, 1e-5f);
  EXPECT_EQ(way(kHand, 1), 0.1f);
  EXPECT_NEAR(size_of(way, kPlaceGroup), 0.5f, 1e-4f);
  for (float& v : way.v) v *= 100.0f;
  EXPECT_TRUE(bound_motion(kHorizons - 1, way));
  EXPECT_NEAR(size_of(way, kLeg), 3.0f, 1e-4f) << "at most, however late";
}

TEST(MotionBounds, ASpinGoesOnOverFullTurns) {
  for (std::size_t h = 0; h < kHorizons; ++h) {
    BodyRow way;
    way(kHeadingGroup, 0) = 15.0f * static_cast<float>(kHorizonFrames[h] / kGridHz);
    const BodyRow was = way;
    EXPECT_TRUE(bound_motion(h, way));
    EXPECT_EQ(way.v, was.v) << "two turns and a half a second, " << h;
  }
}

TEST(MotionBounds, ASlopeIsNoFasterThanBodiesGoOn) {
  BodyRow slope;
  slope.v.fill(5.0f);
  bound_slope(slope);
  EXPECT_NEAR(size_of(slope, index_of(Bone::kHead)) * static_cast<float>(kGridHz), 9.0f, 1e-3f);
  EXPECT_NEAR(size_of(slope, kPlaceGroup) * static_cast<float>(kGridHz), 8.0f, 1e-3f);
  BodyRow spin;
  spin(kHeadingGroup, 0) = 15.0f / static_cast<float>(kGridHz);
  const BodyRow was = spin;
  bound_slope(spin);
  EXPECT_EQ(spin.v, was.v) << "two turns and a half a second are danced";
}

TEST(MotionBounds, InvalidNumbersAreNoMotion) {
  for (const float none :
       {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
    BodyRow way;
    way.v.fill(0.1f);
    way(3, 1) = none;
    EXPECT_FALSE(bound_motion(2, way));
    for (const float v : way.v) EXPECT_EQ(v, 0.0f);
  }
}

}  // namespace
}  // namespace dance
