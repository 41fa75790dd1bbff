#include "formats/camera_view/body_in_frame.h"

#include <gtest/gtest.h>

#include "tests/formats/camera_view/drawn_view.h"

namespace dance {
namespace {

TEST(BodyInFrame, AWholeDancerIsSeenAndMeasured) {
  const BodyInFrame body = body_in_frame(standing_in(0.75f, 0.12f));
  ASSERT_TRUE(body.is_found);
  EXPECT_EQ(seen(body.head), PartSeen::kSeen);
  EXPECT_EQ(seen(body.hands), PartSeen::kSeen);
  EXPECT_EQ(seen(body.knees), PartSeen::kSeen);
  EXPECT_EQ(seen(body.feet), PartSeen::kSeen);
  EXPECT_NEAR(body.height, 0.75f, 0.02f);
  EXPECT_NEAR(body.top_y, 0.12f, 0.01f);
  EXPECT_NEAR(body.bottom_y, 0.87f, 0.01f);
  EXPECT_NEAR(body.centre_x, 0.5f, 1e-4f);
}

// The network says that it sees a head above the picture, as it knows where heads are.
TEST(BodyInFrame, AHeadAboveThePictureIsCutOffHoweverSureTheNetworkIs) {
  const SeenBody2d body = standing_in(0.9f, -0.1f);
  ASSERT_EQ(body.points[0].visibility, 1.0f);
  EXPECT_EQ(seen(body_in_frame(body).head), PartSeen::kCutOff);
  EXPECT_EQ(seen(body_in_frame(body).feet), PartSeen::kSeen);
}

TEST(BodyInFrame, ACrownAboveThePictureIsCutOffThoughTheFaceIsSeen) {
  const SeenBody2d body = standing_in(0.8f, -0.03f);
  ASSERT_GT(body.points[0].y, 0.0f);
  EXPECT_EQ(seen(body_in_frame(body).head), PartSeen::kCutOff);
}

TEST(BodyInFrame, FeetBelowThePictureAreCutOff) {
  const BodyInFrame body = body_in_frame(standing_in(0.95f, 0.15f));
  EXPECT_EQ(seen(body.feet), PartSeen::kCutOff);
  EXPECT_EQ(seen(body.head), PartSeen::kSeen);
}

TEST(BodyInFrame, FeetThatTheNetworkPutsAtTheEdgeUnseenAreCutOffToo) {
  SeenBody2d body = standing_in(0.8f, 0.18f);
  for (std::size_t i = 27; i < kSeenPoints; ++i) body.points[i].visibility = 0.1f;
  EXPECT_EQ(seen(body_in_frame(body).feet), PartSeen::kCutOff);
}

TEST(BodyInFrame, LegsBehindSomethingAreHiddenNotCutOff) {
  SeenBody2d body = standing_in(0.75f, 0.12f);
  for (std::size_t i = 25; i < kSeenPoints; ++i) body.points[i].visibility = 0.15f;
  EXPECT_EQ(seen(body_in_frame(body).knees), PartSeen::kHidden);
  EXPECT_EQ(seen(body_in_frame(body).feet), PartSeen::kHidden);
  EXPECT_EQ(seen(body_in_frame(body).head), PartSeen::kSeen);
}

// From the side one leg hides the other.
TEST(BodyInFrame, OneLegIsEnough) {
  SeenBody2d body = standing_in(0.75f, 0.12f);
  for (const std::size_t right : {26, 28, 30, 32}) body.points[right].visibility = 0.1f;
  EXPECT_EQ(seen(body_in_frame(body).knees), PartSeen::kSeen);
  EXPECT_EQ(seen(body_in_frame(body).feet), PartSeen::kSeen);
}

TEST(BodyInFrame, ADancerOfWhomOnlyTheTorsoIsSeenIsAsTallAsThatSays) {
  SeenBody2d body = standing_in(2.0f, -0.3f);
  for (std::size_t i = 25; i < kSeenPoints; ++i) body.points[i] = {0.5f, 0.99f, 0.1f};
  EXPECT_NEAR(body_in_frame(body).height, 2.0f, 0.1f);
}

TEST(BodyInFrame, NobodyIsNothing) { EXPECT_FALSE(body_in_frame(SeenBody2d{}).is_found); }

}  // namespace
}  // namespace dance
