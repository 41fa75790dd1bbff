#include "producers/camera/hands/hand_region.h"

#include <gtest/gtest.h>

#include "producers/camera/region/half_turn.h"
#include "producers/camera/region/picture_region.h"

namespace dance {
namespace {

using Eigen::Vector2f;
using Eigen::Vector3f;

BodyLandmarks body_with_hand(const Vector2f& wrist, const Vector2f& index, const Vector2f& pinky) {
  BodyLandmarks body;
  body.found = true;
  for (auto& p : body.image_px) p.setZero();
  const auto put = [&](Landmark l, const Vector2f& p) {
    body.image_px[index_of(l)] = {p.x(), p.y(), 0.0f};
    body.visibility[index_of(l)] = 0.9f;
  };
  put(Landmark::kLeftWrist, wrist);
  put(Landmark::kLeftIndex, index);
  put(Landmark::kLeftPinky, pinky);
  return body;
}

TEST(HandRegion, LiesAroundTheKnucklesAndStandsUprightAlongTheHand) {
  const auto up =
      hand_region_of(body_with_hand({100, 200}, {100, 170}, {100, 170}), HandSide::kLeft);
  ASSERT_TRUE(up);
  EXPECT_NEAR(up->centre_x_px, 100.0f, 1e-3f);
  EXPECT_NEAR(up->centre_y_px, 170.0f - 6.0f, 1e-3f);  // a tenth of twice the hand up
  EXPECT_NEAR(up->side_px, 2.7f * 60.0f, 1e-3f);
  EXPECT_NEAR(up->turn_rad, 0.0f, 1e-5f);
  const auto aside =
      hand_region_of(body_with_hand({100, 200}, {130, 200}, {130, 200}), HandSide::kLeft);
  ASSERT_TRUE(aside);
  EXPECT_NEAR(aside->turn_rad, 0.5f * kHalfTurn_rad, 1e-5f);
  EXPECT_NEAR(aside->centre_x_px, 136.0f, 1e-3f);
}

TEST(HandRegion, IsNowhereWhereTheBodyShowsNoWrist) {
  BodyLandmarks body = body_with_hand({100, 200}, {100, 170}, {100, 170});
  EXPECT_FALSE(hand_region_of(body, HandSide::kRight));
  body.visibility[index_of(Landmark::kLeftWrist)] = 0.05f;
  EXPECT_FALSE(hand_region_of(body, HandSide::kLeft));
  body.visibility[index_of(Landmark::kLeftWrist)] = 1.0f;
  body.image_px[index_of(Landmark::kLeftIndex)].x() = std::nanf("");
  EXPECT_FALSE(hand_region_of(body, HandSide::kLeft));
  body.found = false;
  EXPECT_FALSE(hand_region_of(body, HandSide::kLeft));
}

TEST(HandRegion, TheRecropNetworksSecondPointLiesBelowTheMiddle) {
  const BodyRegion searched{200.0f, 100.0f, 80.0f, 0.0f};
  const BodyRegion region = hand_region_between(searched, {0.5f, 0.5f}, {0.5f, 0.75f});
  EXPECT_NEAR(region.side_px, 40.0f, 1e-3f);
  EXPECT_NEAR(region.turn_rad, 0.0f, 1e-5f);
  EXPECT_NEAR(region.centre_y_px, 96.0f, 1e-3f);
}

std::array<Vector3f, kHandPointCount> upright_hand(float x, float y, float size) {
  std::array<Vector3f, kHandPointCount> points;
  points[0] = {x, y, 0.0f};
  for (std::size_t finger = 0; finger < 5; ++finger)
    for (std::size_t joint = 0; joint < 4; ++joint)
      points[1 + 4 * finger + joint] = {x + size * 0.1f * (static_cast<float>(finger) - 2.0f),
                                        y - size * (0.5f + 0.15f * static_cast<float>(joint)),
                                        0.0f};
  return points;
}

TEST(HandRegion, AroundAHandHasItsFingersInIt) {
  const auto points = upright_hand(300.0f, 400.0f, 100.0f);
  const BodyRegion region = hand_region_around(points);
  EXPECT_NEAR(region.turn_rad, 0.0f, 1e-4f);
  for (const Vector3f& p : points)
    EXPECT_LT((p.head<2>() - centre_of(region)).cwiseAbs().maxCoeff(), 0.5f * region.side_px);
}

TEST(HandRegion, AnotherPlaceOrAnotherTurnIsAnotherHand) {
  const auto points = upright_hand(300.0f, 400.0f, 100.0f);
  const BodyRegion around = hand_region_around(points);
  EXPECT_TRUE(is_same_hand(points, around, around));
  BodyRegion far = around, turned = around, small = around;
  far.centre_x_px += 0.25f * around.side_px;
  turned.turn_rad += radians(45.0f);
  small.side_px *= 0.6f;
  EXPECT_FALSE(is_same_hand(points, around, far));
  EXPECT_FALSE(is_same_hand(points, around, turned));
  EXPECT_FALSE(is_same_hand(points, around, small));
  // Over the half turn it is the same.
  BodyRegion down = around, nearly = around;
  down.turn_rad = radians(179.0f);
  nearly.turn_rad = radians(-179.0f);
  const std::array<Vector3f, kHandPointCount> middle = [&] {
    std::array<Vector3f, kHandPointCount> all;
    all.fill({around.centre_x_px, around.centre_y_px, 0.0f});
    return all;
  }();
  EXPECT_TRUE(is_same_hand(middle, down, nearly));
}

}  // namespace
}  // namespace dance
