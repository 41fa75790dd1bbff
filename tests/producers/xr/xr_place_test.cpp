// Places as a runtime tells them, and where a dancer is put in the house.
#include <gtest/gtest.h>

#include <limits>
#include <numbers>

#include "core/pose/heading.h"
#include "producers/xr/xr_sensors.h"

namespace dance {
namespace {

using Eigen::Quaternionf;
using Eigen::Vector3f;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kPi = std::numbers::pi_v<float>;

XrSpaceLocation tracked_location() {
  XrSpaceLocation location{};
  location.type = XR_TYPE_SPACE_LOCATION;
  location.locationFlags =
      XR_SPACE_LOCATION_POSITION_VALID_BIT | XR_SPACE_LOCATION_ORIENTATION_VALID_BIT |
      XR_SPACE_LOCATION_POSITION_TRACKED_BIT | XR_SPACE_LOCATION_ORIENTATION_TRACKED_BIT;
  location.pose = {{0.0f, 0.0f, 0.0f, 1.0f}, {1.0f, 2.0f, 3.0f}};
  return location;
}

TEST(XrPlaceOf, TakesAPlaceAsItIsAndMakesItsRotationWhole) {
  XrSpaceLocation location = tracked_location();
  location.pose.orientation = {0.0f, 0.6025f, 0.0f, 0.8025f};  // a bit longer than 1
  const auto place = place_of(location, true);
  ASSERT_TRUE(place);
  EXPECT_EQ(place->p_m, Vector3f(1.0f, 2.0f, 3.0f));
  EXPECT_NEAR(place->R.norm(), 1.0f, 1e-6f);
  EXPECT_NEAR(place->R.y() / place->R.w(), 0.6025f / 0.8025f, 1e-5f);
}

TEST(XrPlaceOf, RefusesNumbersThatAreNoPlace) {
  for (const float bad : {kNan, std::numeric_limits<float>::infinity(), 1001.0f, -1e30f})
    for (float XrVector3f::*axis : {&XrVector3f::x, &XrVector3f::y, &XrVector3f::z}) {
      XrSpaceLocation location = tracked_location();
      location.pose.position.*axis = bad;
      EXPECT_FALSE(place_of(location, false)) << bad;
    }
}

TEST(XrPlaceOf, RefusesQuaternionsThatAreNoRotation) {
  for (const XrQuaternionf& bad :
       {XrQuaternionf{0.0f, 0.0f, 0.0f, 0.0f}, XrQuaternionf{0.0f, 0.0f, 0.0f, 2.0f},
        XrQuaternionf{kNan, 0.0f, 0.0f, 1.0f}, XrQuaternionf{0.0f, 0.0f, 0.0f, 0.98f}}) {
    XrSpaceLocation location = tracked_location();
    location.pose.orientation = bad;
    EXPECT_FALSE(place_of(location, false));
  }
}

TEST(XrPlaceOf, RefusesWhatIsNotKnownAndWhatIsGuessedWhereItMustBeTracked) {
  XrSpaceLocation guessed = tracked_location();
  guessed.locationFlags =
      XR_SPACE_LOCATION_POSITION_VALID_BIT | XR_SPACE_LOCATION_ORIENTATION_VALID_BIT;
  EXPECT_TRUE(place_of(guessed, false));
  EXPECT_FALSE(place_of(guessed, true));
  for (const XrSpaceLocationFlags missing :
       {XR_SPACE_LOCATION_POSITION_VALID_BIT, XR_SPACE_LOCATION_ORIENTATION_VALID_BIT}) {
    XrSpaceLocation location = tracked_location();
    location.locationFlags &= ~missing;
    EXPECT_FALSE(place_of(location, false));
  }
}

TEST(XrPlacement, PutsTheHeadOverTheSpotLookingAlongItsHeading) {
  for (const float yaw : {0.0f, 1.0f, -2.5f, 3.1f})
    for (const float pitch : {0.0f, 0.7f, -0.7f})
      for (const float heading : {0.0f, 1.5f, -3.0f}) {
        // Turned to +Z, as OpenXR's heads look along -Z, and nodding.
        const Quaternionf R =
            about_up(yaw + kPi) * Quaternionf(Eigen::AngleAxisf(pitch, Vector3f::UnitX()));
        const XrPlace head{{0.4f, 1.6f, -2.0f}, R};
        const XrPlacement placement = placement_of(head, {3.0f, -1.0f, heading}, 0.0f);
        const XrPlace placed = placement.in_house(head);
        EXPECT_LT((placed.p_m - Vector3f(3.0f, 1.6f, -1.0f)).norm(), 1e-5f) << "height stays";
        const Vector3f looks = placed.R * -Vector3f::UnitZ();
        EXPECT_NEAR(std::remainder(std::atan2(looks.x(), looks.z()) - heading, 2.0f * kPi), 0.0f,
                    1e-5f);
        EXPECT_NEAR((placement.turn() * Vector3f::UnitY()).y(), 1.0f, 1e-6f) << "stays upright";
      }
}

TEST(XrPlacement, StandsOnAFloorThatIsNotAtZero) {
  const XrPlace head{{0.0f, 0.1f, 0.0f}, Quaternionf::Identity()};
  const XrPlacement placement = placement_of(head, {}, -1.5f);
  EXPECT_NEAR(placement.in_house(head.p_m).y(), 1.6f, 1e-6f);
  EXPECT_NEAR(placement.in_house(Vector3f(2.0f, -1.5f, 1.0f)).y(), 0.0f, 1e-6f);
}

}  // namespace
}  // namespace dance
