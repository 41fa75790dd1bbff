// What the sensors tell, against what the script shows: points, moments, hands, buttons, and what
// is felt.
#include "producers/xr/xr_sensors.h"

#include <gtest/gtest.h>

#include "core/pose/heading.h"
#include "tests/producers/xr/xr_world.h"

namespace dance {
namespace {

using Eigen::Quaternionf;
using Eigen::Vector3f;

class XrSenses : public XrWorld {
 protected:
  void open_sensors(const std::string& script) {
    open_focused(script);
    sensors_ = std::make_unique<XrSensors>(*session_, *input_);
    ASSERT_EQ(sensors_->note(), "");
  }
  void TearDown() override {
    sensors_.reset();
    XrWorld::TearDown();
  }
  const XrSight& look(const XrPlacement& placement = {}) {
    const MonoTime now = mono_now();
    sensors_->look(runtime_->xr_of(now), now, placement, sight_);
    EXPECT_EQ(sight_.points.time, now);
    return sight_;
  }
  bool sees(TrackedPoint point) {
    pump();
    return look().points.has(point);
  }

  std::unique_ptr<XrSensors> sensors_;
  XrSight sight_;
};

TEST_F(XrSenses, AllPointsAreWhereTheScriptHasThem) {
  std::string script;
  for (std::size_t i = 0; i < kTrackedPointCount; ++i)
    script += "at 0 pose " + std::string(kTrackedPointNames[i]) + " " +
              std::to_string(0.1 * static_cast<double>(i)) + " 1 -0.5 0 0.6 0 0.8\n";
  open_sensors(script);
  ASSERT_TRUE(pump_until([&] { return look().points.presence == (1u << kTrackedPointCount) - 1; }))
      << look().points.presence << record();
  EXPECT_TRUE(is_valid(sight_.points));
  for (std::size_t i = 0; i < kTrackedPointCount; ++i) {
    const Vector3f wanted(0.1f * static_cast<float>(i), 1.0f, -0.5f);
    EXPECT_LT((sight_.points.p_WT_m[i] - wanted).norm(), 1e-4f) << kTrackedPointNames[i];
    EXPECT_LT(sight_.points.R_WT[i].angularDistance(Quaternionf(0.8f, 0.0f, 0.6f, 0.0f)), 1e-3f);
    const bool is_tracker = i >= index_of(TrackedPoint::kHips);
    const std::string name(is_tracker ? kTrackedPointNames[i] : i == 0 ? "view" : "left-hand");
    EXPECT_TRUE(has_recorded("located " + name)) << name;
  }
}

TEST_F(XrSenses, PointsArePutWhereTheHouseHasThem) {
  open_sensors("at 0 pose head 1 1.5 0 0 0 0 1\n");
  XrPlacement placement;
  placement.turn_rad = 1.5707963f;
  placement.shift_m = {0.0f, 0.25f, 5.0f};
  ASSERT_TRUE(pump_until([&] { return look(placement).points.has(TrackedPoint::kHead); }));
  // A quarter to the left: +X becomes -Z.
  EXPECT_LT((sight_.points.position(TrackedPoint::kHead) - Vector3f(0.0f, 1.75f, 4.0f)).norm(),
            1e-4f);
  EXPECT_LT(sight_.points.rotation(TrackedPoint::kHead).angularDistance(about_up(1.5707963f)),
            1e-3f);
}

// One metre a second along X: where it is says of which moment it is, whatever the machine does.
TEST_F(XrSenses, AMovingPointIsWhereItIsAtTheMomentThatWasAskedFor) {
  std::string script;
  for (const char* point : {"head", "right-hand", "left-foot"})
    script += "at 0 pose " + std::string(point) + " 0 1 0 0 0 0 1\nat 500 pose " + point +
              " 500 1 0 0 0 0 1\n";
  open_sensors(script);
  ASSERT_TRUE(pump_to(0.2));
  ASSERT_TRUE(pump_until([&] { return sees(TrackedPoint::kLeftFoot); }));
  for (const Duration ahead : {Duration(), Duration::ms(300), Duration::s(20), -Duration::ms(50)}) {
    pump();
    const MonoTime moment = mono_now() + ahead;
    sensors_->look(runtime_->xr_of(moment), moment, {}, sight_);
    for (const TrackedPoint point :
         {TrackedPoint::kHead, TrackedPoint::kRightHand, TrackedPoint::kLeftFoot}) {
      ASSERT_TRUE(sight_.points.has(point));
      const double x = static_cast<double>(sight_.points.position(point).x());
      EXPECT_GE(x, (moment - not_after_).as_seconds() - 1e-4);
      EXPECT_LE(x, (moment - not_before_).as_seconds() + 1e-4);
    }
  }
}

TEST_F(XrSenses, LostAndGuessedPointsAreNotTold) {
  open_sensors(
      "system hands off\nat 0 pose hips 0 1 0 0 0 0 1\n"
      "at 0.5 lose left-hand\nat 0.5 guess right-hand\nat 0.5 guess hips\n"
      "at 1 find left-hand\nat 1 find right-hand\nat 1 find hips\n"
      "at 1.5 lose head\nat 4 guess head\n");
  constexpr std::array kPoints{TrackedPoint::kLeftHand, TrackedPoint::kRightHand,
                               TrackedPoint::kHips};
  for (const TrackedPoint point : kPoints)
    EXPECT_TRUE(pump_until([&] { return sees(point); })) << kTrackedPointNames[index_of(point)];
  ASSERT_TRUE(pump_to(0.5));
  if (mono_now() < not_before_ + Duration::seconds(0.9)) {
    for (const TrackedPoint point : kPoints)
      EXPECT_FALSE(look().points.has(point)) << kTrackedPointNames[index_of(point)];
  }
  for (const TrackedPoint point : kPoints) EXPECT_TRUE(pump_until([&] { return sees(point); }));
  EXPECT_TRUE(pump_until([&] { return !sees(TrackedPoint::kHead); }));
  EXPECT_TRUE(pump_until([&] { return sees(TrackedPoint::kHead); }))
      << "a head is better guessed than none";
}

TEST_F(XrSenses, NumbersThatAreNoneAreNotTold) {
  open_sensors("at 0.3 nan head\nat 0.3 zero_quaternion left-hand\n");
  bool was_without = false;
  ASSERT_TRUE(pump_until([&] {
    look();
    was_without = was_without || !sight_.points.has(TrackedPoint::kHead);
    EXPECT_TRUE(is_valid(sight_.points));
    return mono_now() > not_after_ + Duration::seconds(0.6);
  }));
  EXPECT_TRUE(sees(TrackedPoint::kHead));
  if (!was_without) GTEST_SKIP() << "the machine slept through it";
}

TEST_F(XrSenses, BareHandsAreGripsWhereNoControllerIsHeld) {
  open_sensors(
      "profile none\nat 0 pose left-hand -0.3 1 -0.2 0 0.6 0 0.8\n"
      "at 0 pose right-hand 0.3 1.1 -0.2 0 0 0 1\nat 0 hands fist\n");
  ASSERT_TRUE(pump_until([&] { return look().is_bare[0] && sight_.is_bare[1]; }));
  ASSERT_TRUE(sight_.points.has(TrackedPoint::kLeftHand));
  EXPECT_LT((sight_.points.position(TrackedPoint::kLeftHand) - Vector3f(-0.3f, 1.0f, -0.2f)).norm(),
            1e-3f);
  EXPECT_LT(sight_.points.rotation(TrackedPoint::kLeftHand)
                .angularDistance(Quaternionf(0.8f, 0.0f, 0.6f, 0.0f)),
            2e-3f);
  EXPECT_LT((sight_.fingertips_W_m[0] - Vector3f(-0.3f, 1.0f, -0.2f)).norm(), 0.25f);
  EXPECT_GT((sight_.fingertips_W_m[0] - Vector3f(-0.3f, 1.0f, -0.2f)).norm(), 0.01f);
  EXPECT_TRUE(is_valid(sight_.hands));
  EXPECT_EQ(sight_.hands.presence, (1u << kFingerBoneCount) - 1);
  const auto middle = [&](std::size_t side) {
    return sight_.hands.R_PB[side * (kFingerBoneCount / 2) + 7];
  };
  for (const std::size_t side : {0u, 1u})
    EXPECT_NEAR(middle(side).angularDistance(Quaternionf::Identity()), 1.4f, 1e-2f);
}

// Behind a back, or between two bodies: some runtimes make joints of controllers.
TEST_F(XrSenses, AControllerOutOfSightIsNoBareHand) {
  open_sensors("at 0.5 guess left-hand\n");
  ASSERT_TRUE(pump_until([&] { return sees(TrackedPoint::kLeftHand); }));
  ASSERT_TRUE(pump_until([&] { return !look().points.has(TrackedPoint::kLeftHand); }));
  EXPECT_FALSE(sight_.is_bare[0] || sight_.is_pinching[0]);
  EXPECT_TRUE(sight_.points.has(TrackedPoint::kRightHand));
}

TEST_F(XrSenses, HandsThatAreNotSeenHaveNoFingers) {
  open_sensors("at 0 lose left-hand\nat 0 lose right-hand\n");
  ASSERT_TRUE(pump_until([&] { return sees(TrackedPoint::kHead); }));
  EXPECT_EQ(sight_.hands.presence, 0u);
  EXPECT_FALSE(sight_.is_bare[0] || sight_.is_bare[1]);
  EXPECT_FALSE(sight_.points.has(TrackedPoint::kLeftHand));
}

TEST_F(XrSenses, EachControllersTriggerPressesAndItsMenuButtonOpensThePanel) {
  struct Buttons {
    const char* profile;
    const char* press;
    const char* left_menu;
    const char* right_menu;
  };
  for (const Buttons& it : {Buttons{"oculus/touch_controller", "trigger", "menu", "b"},
                            Buttons{"valve/index_controller", "trigger", "b", "b"},
                            Buttons{"htc/vive_controller", "trigger", "menu", "menu"},
                            Buttons{"microsoft/motion_controller", "trigger", "menu", "menu"},
                            Buttons{"khr/simple_controller", "select", "menu", "menu"},
                            Buttons{"unheard/of", "select", "menu", "menu"}}) {
    open_focused("profile " + std::string(it.profile) + "\nat 0.2 press left " + it.press +
                 "\nat 0.4 press right " + it.press + "\nat 0.6 press left " + it.left_menu +
                 "\nat 0.8 press right " + it.right_menu + "\nat 2 release left " + it.press +
                 "\n");
    const auto comes = [&](auto pressed, XrHand hand) {
      return pump_until([&] { return ((*input_).*pressed)(hand); });
    };
    EXPECT_TRUE(comes(&XrInput::is_pressed, XrHand::kLeft)) << it.profile;
    EXPECT_TRUE(comes(&XrInput::is_pressed, XrHand::kRight)) << it.profile;
    EXPECT_TRUE(comes(&XrInput::is_menu_pressed, XrHand::kLeft)) << it.profile;
    EXPECT_TRUE(comes(&XrInput::is_menu_pressed, XrHand::kRight)) << it.profile;
    EXPECT_TRUE(pump_until([&] { return !input_->is_pressed(XrHand::kLeft); })) << it.profile;
    EXPECT_TRUE(input_->is_pressed(XrHand::kRight));
  }
}

TEST_F(XrSenses, AHandPointsAlongItsAim) {
  open_focused("at 0 pose right-hand 1 1 1 0 0 0 1\n");
  std::optional<XrPlace> aim;
  ASSERT_TRUE(
      pump_until([&] { return (aim = input_->aim(XrHand::kRight, xr_now())).has_value(); }));
  const Vector3f along = aim->R * -Vector3f::UnitZ();
  EXPECT_LT((along - Vector3f(0.0f, -0.70710678f, -0.70710678f)).norm(), 1e-3f);
  EXPECT_LT((aim->p_m - Vector3f(1.0f, 1.02f, 0.94f)).norm(), 1e-3f);
}

TEST_F(XrSenses, WhatIsFeltIsFeltInThatHandAsStrongAndAsLongAsItWasSaid) {
  open_focused("");
  pump();
  EXPECT_TRUE(input_->vibrate(XrHand::kRight, 0.5f, Duration::ms(40), 160.0f));
  EXPECT_TRUE(has_recorded("haptic right 0.5000 40000000 160.00 ")) << record();
  EXPECT_FALSE(has_recorded("haptic left"));
  EXPECT_TRUE(input_->vibrate(XrHand::kLeft, 1.0f, Duration::ms(7), 0.0f));
  EXPECT_TRUE(has_recorded("haptic left 1.0000 7000000 0.00 ")) << record();
  input_->stop(XrHand::kLeft);
  EXPECT_TRUE(has_recorded("haptic_stop left"));
  EXPECT_FALSE(has_recorded("haptic_stop right"));
}

TEST_F(XrSenses, NothingIsFeltWhileTheHeadsetsMenuIsOpen) {
  open_focused("at 0.1 focus off\n");
  ASSERT_TRUE(pump_until([&] { return !session_->is_focused(); }));
  EXPECT_FALSE(input_->vibrate(XrHand::kRight, 0.5f, Duration::ms(40), 0.0f));
  EXPECT_FALSE(input_->grip(XrHand::kRight, xr_now()));
  EXPECT_TRUE(input_->head(xr_now())) << "the dance goes on";
}

}  // namespace
}  // namespace dance
