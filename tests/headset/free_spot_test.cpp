// Where a dancer with a headset is put on the stage.
#include "headset/capture/free_spot.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/pose/heading.h"
#include "headset/program/headset_options.h"

namespace dance {
namespace {

constexpr float kPi = std::numbers::pi_v<float>;
const MonoTime kNow = MonoTime::from_ns(100'000'000'000);

Pose standing(float x_m, float z_m, float heading_rad) {
  Pose pose;
  pose.p_WH_m = {x_m, 0.95f, z_m};
  pose.R_PB[0] = about_up(heading_rad);
  return pose;
}

GuestId guest(const std::string& name) { return *GuestId::parse(name); }

void expect_spot(const XrSpot& spot, float x_m, float z_m, float heading_rad) {
  EXPECT_NEAR(spot.x_m, x_m, 1e-4f);
  EXPECT_NEAR(spot.z_m, z_m, 1e-4f);
  EXPECT_NEAR(std::remainder(spot.heading_rad - heading_rad, 2.0f * kPi), 0.0f, 1e-4f);
}

TEST(FreeSpot, OnAnEmptyStageItIsTheOneThatIsWanted) {
  expect_spot(FreeSpot().before({1.0f, -2.0f, 0.5f}, kNow), 1.0f, -2.0f, 0.5f);
}

TEST(FreeSpot, BeforeWhoStandsThereFaceToFace) {
  FreeSpot spots;
  spots.hear(guest("bob"), standing(0.2f, 0.1f, 0.0f), kNow);
  expect_spot(spots.before({}, kNow), 0.2f, 1.2f, kPi);
  // Bob turns: to the left, who looks along +X.
  spots.hear(guest("bob"), standing(0.2f, 0.1f, 0.5f * kPi), kNow);
  expect_spot(spots.before({}, kNow), 1.3f, 0.1f, 1.5f * kPi);
}

TEST(FreeSpot, WhoIsFarAwayOrSilentIsNotMinded) {
  FreeSpot spots;
  spots.hear(guest("bob"), standing(1.0f, 0.0f, 0.0f), kNow);
  spots.hear(guest("eve"), standing(0.0f, 0.0f, 0.0f), kNow - Duration::s(3));
  expect_spot(spots.before({}, kNow), 0.0f, 0.0f, 0.0f);
  spots.hear(guest("bob"), standing(0.0f, 0.0f, 0.0f), kNow);
  EXPECT_GT(spots.before({}, kNow).z_m, 1.0f);
  expect_spot(spots.before({}, kNow + Duration::s(3)), 0.0f, 0.0f, 0.0f);
}

TEST(FreeSpot, TheNearestOfSeveralCounts) {
  FreeSpot spots;
  spots.hear(guest("bob"), standing(0.6f, 0.0f, 0.0f), kNow);
  spots.hear(guest("eve"), standing(-0.1f, 0.0f, -0.5f * kPi), kNow);
  expect_spot(spots.before({}, kNow), -1.2f, 0.0f, 0.5f * kPi);
}

TEST(FreeSpot, NobodyIsPutIntoACoupleOrACrowd) {
  FreeSpot spots;
  std::vector<XrSpot> taken;
  const auto put = [&](const XrSpot& spot) {
    spots.hear(guest("g" + std::to_string(taken.size())),
               standing(spot.x_m, spot.z_m, spot.heading_rad), kNow);
    taken.push_back(spot);
  };
  // Each who comes wants the middle.
  for (int i = 0; i < 12; ++i) {
    const XrSpot spot = spots.before({}, kNow);
    for (const XrSpot& other : taken)
      ASSERT_GT(std::hypot(spot.x_m - other.x_m, spot.z_m - other.z_m), 0.7f)
          << i << " stands in another";
    EXPECT_LT(std::hypot(spot.x_m, spot.z_m), 6.0f);
    put(spot);
  }
}

TEST(FreeSpot, MoreThanThereIsRoomForAreNotMindedAndThoseWhoLeftMakeRoom) {
  FreeSpot spots;
  for (std::size_t i = 0; i < FreeSpot::kMost; ++i)
    spots.hear(guest("g" + std::to_string(i)), standing(50.0f, 0.0f, 0.0f), kNow);
  spots.hear(guest("bob"), standing(0.0f, 0.0f, 0.0f), kNow);
  expect_spot(spots.before({}, kNow), 0.0f, 0.0f, 0.0f);
  const MonoTime later = kNow + Duration::s(5);
  spots.hear(guest("bob"), standing(0.0f, 0.0f, 0.0f), later);
  expect_spot(spots.before({}, later), 0.0f, 1.1f, kPi);
}

TEST(HeadsetSpot, IsReadFromMetresAndDegrees) {
  const auto plain = parse_spot("1.5,-2");
  ASSERT_TRUE(plain);
  expect_spot(*plain, 1.5f, -2.0f, 0.0f);
  const auto turned = parse_spot("0,1.2,180");
  ASSERT_TRUE(turned);
  expect_spot(*turned, 0.0f, 1.2f, kPi);
  ASSERT_TRUE(parse_spot("-0.5,0,-90"));
}

TEST(HeadsetSpot, ThatIsNoneNamesItselfAndTheRule) {
  for (const char* text : {"", "1", "1,", ",1", "1,2,", "1,2,3,4", "a,b", "1;2", "1, 2", "nan,0",
                           "inf,0", "1e9,0", "0,0,90deg", "1,,2"}) {
    const auto spot = parse_spot(text);
    ASSERT_FALSE(spot) << text;
    EXPECT_NE(spot.error().what.find("'" + std::string(text) + "'"), std::string::npos);
    EXPECT_NE(spot.error().what.find("X,Z,HEADING"), std::string::npos);
  }
}

}  // namespace
}  // namespace dance
