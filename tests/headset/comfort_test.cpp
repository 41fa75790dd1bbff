// What keeps a dancer in a headset at ease.
#include "headset/comfort/comfort.h"

#include <gtest/gtest.h>

#include "tests/viewer/test_scene.h"

namespace dance {
namespace {

using Eigen::Vector3f;

const GuestId kOwn = *GuestId::parse("own");

TEST(Comfort, OthersFadeOverThePersonalSpaceAndAreGoneAtAThirdOfIt) {
  EXPECT_EQ(opacity_at(10.0f, 0.45f), 1.0f);
  EXPECT_FLOAT_EQ(opacity_at(0.45f, 0.45f), 1.0f);
  EXPECT_NEAR(opacity_at(0.3f, 0.45f), 0.5f, 1e-5f);
  EXPECT_NEAR(opacity_at(0.15f, 0.45f), 0.0f, 1e-5f);
  EXPECT_EQ(opacity_at(0.0f, 0.45f), 0.0f);
  float last = 0.0f;
  for (float distance_m = 0.0f; distance_m < 1.0f; distance_m += 0.01f) {
    EXPECT_GE(opacity_at(distance_m, 0.6f), last);
    last = opacity_at(distance_m, 0.6f);
  }
}

TEST(Comfort, WithoutAPersonalSpaceNobodyFades) {
  for (const float distance_m : {0.0f, 0.1f, 5.0f}) EXPECT_EQ(opacity_at(distance_m, 0.0f), 1.0f);
}

TEST(Comfort, HowNearSomebodyIsCountsToTrunkAndHead) {
  const SceneGuest guest = guest_in_t_pose("bob");
  const float hips_m = guest.pose.p_WH_m.y();
  EXPECT_NEAR(distance_to_guest_m({0.0f, hips_m + 0.3f, 0.5f}, guest), 0.5f, 0.06f);
  EXPECT_NEAR(distance_to_guest_m({0.0f, hips_m - 0.4f, 0.0f}, guest), 0.4f, 0.01f) << "below";
  const float top_m = standing_height_m(guest.skeleton);
  EXPECT_NEAR(distance_to_guest_m({0.0f, top_m + 1.0f, 0.0f}, guest), 1.0f, 0.06f) << "above";
  // A hand that reaches over is not the body.
  EXPECT_GT(distance_to_guest_m({0.7f, 1.4f, 0.0f}, guest), 0.6f);
}

TEST(Comfort, TheOwnBodyNeverFadesAndOthersFadeBesideWhatFadesThemAlready) {
  std::vector<SceneGuest> guests{guest_in_t_pose("own"), guest_in_t_pose("bob"),
                                 guest_in_t_pose("eve")};
  guests[1].pose.p_WH_m.z() = 0.3f;
  guests[1].opacity = 0.5f;
  guests[2].pose.p_WH_m.z() = 3.0f;
  keep_personal_space({0.45f, 8.0f}, {0.0f, 1.5f, 0.0f}, kOwn, guests);
  EXPECT_EQ(guests[0].opacity, 1.0f);
  EXPECT_NEAR(guests[1].opacity, 0.25f, 0.08f);
  EXPECT_EQ(guests[2].opacity, 1.0f);
}

TEST(JumpFade, IsDarkAtOnceAfterAJumpAndLightAgainSoon) {
  JumpFade fade;
  const MonoTime begin = MonoTime::from_ns(5'000'000'000);
  EXPECT_EQ(fade.darkness(begin), 0.0f);
  fade.jump(begin);
  EXPECT_EQ(fade.darkness(begin), 1.0f);
  float last = 1.0f;
  for (int ms = 0; ms < 1000; ms += 10) {
    const float darkness = fade.darkness(begin + Duration::ms(ms));
    EXPECT_LE(darkness, last);
    last = darkness;
  }
  EXPECT_EQ(last, 0.0f);
  EXPECT_GT(fade.darkness(begin + Duration::ms(200)), 0.0f);
  fade.jump(begin + Duration::s(9));
  EXPECT_EQ(fade.darkness(begin + Duration::s(9)), 1.0f);
}

}  // namespace
}  // namespace dance
