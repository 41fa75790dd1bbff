// The panel at the wrist: when it shows, and which of its buttons were pressed.
#include "headset/panel/wrist_panel.h"

#include <gtest/gtest.h>

#include <map>

namespace dance {
namespace {

using Eigen::Isometry3f;
using Eigen::Matrix3f;
using Eigen::Vector3f;

constexpr std::array<PanelAction, kPanelActions> kAllActions{
    PanelAction::kMute, PanelAction::kRecentre, PanelAction::kCalibrate, PanelAction::kLeave};
const Vector3f kEyes_m(0.0f, 1.6f, 0.0f);
const Vector3f kPanel_m(0.0f, 1.6f, -0.4f);

Isometry3f isometry(const Vector3f& p_m, const Matrix3f& R) {
  Isometry3f X = Isometry3f::Identity();
  X.translation() = p_m;
  X.linear() = R;
  return X;
}

// The grip whose panel is there, facing +Z and upright: out of the back of a left hand, over the
// wrist.
Isometry3f grip_for(const Vector3f& panel_m) {
  Matrix3f R;
  R.col(0) = -Vector3f::UnitZ();
  R.col(1) = -Vector3f::UnitX();
  R.col(2) = Vector3f::UnitY();
  return isometry(panel_m - WristPanel::kOverBack_m * Vector3f::UnitZ() -
                      WristPanel::kTowardsFingers_m * Vector3f::UnitX(),
                  R);
}

Vector3f point_on(PanelAction action) {
  const PanelArea area = WristPanel::area_of(action);
  const float u = 0.5f * (area.u0 + area.u1), v = 0.5f * (area.v0 + area.v1);
  return kPanel_m +
         Vector3f((u - 0.5f) * WristPanel::kWidth_m, (0.5f - v) * WristPanel::kHeight_m, 0.0f);
}

Isometry3f ray(const Vector3f& from, const Vector3f& to) {
  return isometry(
      from, Eigen::Quaternionf::FromTwoVectors(-Vector3f::UnitZ(), to - from).toRotationMatrix());
}

class WristPanelTest : public ::testing::Test {
 protected:
  WristPanelTest() {
    input_.eyes_W_m = kEyes_m;
    input_.left_grip_W = grip_for(kPanel_m);
  }
  // So long with what the input is; counts what was pressed.
  void turn(Duration time = Duration::ms(11)) {
    constexpr Duration kPicture = Duration::ms(11);
    for (Duration done; done < time; done += kPicture) {
      now_ = now_ + kPicture;
      if (const auto action = panel_.update(input_, now_)) ++pressed_[*action];
    }
  }
  void show() {
    turn(Duration::ms(600));
    ASSERT_EQ(panel_.opacity(), 1.0f);
  }
  void aim_at(const Vector3f& point_m) { input_.right_aim_W = ray({0.3f, 1.2f, -0.1f}, point_m); }
  void press(Duration time = Duration::ms(200)) {
    input_.is_pressed = true;
    turn(time);
    input_.is_pressed = false;
    turn(Duration::ms(50));
  }
  int presses() const {
    int count = 0;
    for (const auto& [action, times] : pressed_) count += times;
    return count;
  }

  WristPanel panel_;
  WristPanel::Input input_;
  MonoTime now_ = MonoTime::from_ns(1'000'000'000);
  std::map<PanelAction, int> pressed_;
};

TEST_F(WristPanelTest, IsAboveTheBackOfTheWristUprightForWhoLooksAtIt) {
  show();
  EXPECT_LT((panel_.board().centre_W_m - kPanel_m).norm(), 1e-5f);
  EXPECT_LT((panel_.board().axes_W - Matrix3f::Identity()).norm(), 1e-5f);
}

TEST_F(WristPanelTest, OpensByLookingAtItAndFadesWhenTheHandIsTurnedAway) {
  turn(Duration::ms(200));
  EXPECT_EQ(panel_.opacity(), 0.0f) << "a glance is not enough";
  turn(Duration::ms(120));
  EXPECT_GT(panel_.opacity(), 0.0f);
  EXPECT_LT(panel_.opacity(), 1.0f) << "it fades in";
  show();
  // A little further turned than it opens at, it stays; then it goes.
  const Isometry3f straight = *input_.left_grip_W;
  const auto turn_hand = [&](float rad) {
    Isometry3f about_panel = Isometry3f::Identity();
    about_panel.translate(kPanel_m).rotate(Eigen::AngleAxisf(rad, Vector3f::UnitY()));
    about_panel.translate(-kPanel_m);
    input_.left_grip_W = about_panel * straight;
    turn(Duration::s(1));
  };
  turn_hand(0.7f);
  EXPECT_EQ(panel_.opacity(), 1.0f);
  turn_hand(0.9f);
  EXPECT_EQ(panel_.opacity(), 0.0f);
  turn_hand(0.7f);
  EXPECT_EQ(panel_.opacity(), 0.0f) << "it opens later than it closes";
}

TEST_F(WristPanelTest, AHandOnAPartnersShoulderShowsNoPanel) {
  input_.looks_W = Vector3f(-0.8f, 0.0f, -0.6f);  // past it, at the partner
  turn(Duration::s(1));
  EXPECT_EQ(panel_.opacity(), 0.0f);
  input_.looks_W = -Vector3f::UnitZ();
  show();
}

TEST_F(WristPanelTest, IsHiddenFarAwayTurnedAwayAndWithoutAHand) {
  input_.left_grip_W = grip_for({0.0f, 1.6f, -0.9f});
  turn(Duration::s(1));
  EXPECT_EQ(panel_.opacity(), 0.0f) << "too far to be read";
  input_.left_grip_W = grip_for({0.0f, 1.6f, 0.3f});
  turn(Duration::s(1));
  EXPECT_EQ(panel_.opacity(), 0.0f) << "seen from behind";
  input_.left_grip_W.reset();
  turn(Duration::s(1));
  EXPECT_EQ(panel_.opacity(), 0.0f);
}

TEST_F(WristPanelTest, TheMenuButtonOpensItWhereverTheHandIsAndHidesItAgain) {
  input_.left_grip_W = grip_for({0.0f, 0.8f, 0.3f});
  input_.menu_pressed = true;
  turn(Duration::s(1));
  EXPECT_EQ(panel_.opacity(), 1.0f) << "a press is one press";
  input_.menu_pressed = false;
  turn(Duration::s(1));
  EXPECT_EQ(panel_.opacity(), 1.0f);
  input_.menu_pressed = true;
  turn(Duration::s(1));
  EXPECT_EQ(panel_.opacity(), 0.0f);
}

TEST_F(WristPanelTest, ItsButtonsAreOnItAndApart) {
  for (const PanelAction a : kAllActions) {
    const PanelArea area = WristPanel::area_of(a);
    EXPECT_TRUE(area.u0 > 0.0f && area.u1 < 1.0f && area.v0 > 0.3f && area.v1 < 1.0f);
    for (const PanelAction b : kAllActions) {
      const PanelArea other = WristPanel::area_of(b);
      const bool is_apart =
          area.u1 < other.u0 || other.u1 < area.u0 || area.v1 < other.v0 || other.v1 < area.v0;
      EXPECT_EQ(is_apart, a != b);
    }
  }
}

TEST_F(WristPanelTest, EachButtonIsPressedOnceForEachPress) {
  show();
  for (const PanelAction action :
       {PanelAction::kMute, PanelAction::kRecentre, PanelAction::kCalibrate}) {
    pressed_.clear();
    aim_at(point_on(action));
    turn();
    ASSERT_TRUE(panel_.hovered());
    EXPECT_EQ(*panel_.hovered(), action);
    ASSERT_TRUE(panel_.pointer());
    press(Duration::s(2));
    EXPECT_EQ(pressed_[action], 1);
    press();
    EXPECT_EQ(pressed_[action], 2);
    EXPECT_EQ(presses(), 2);
  }
}

TEST_F(WristPanelTest, BesideTheButtonsNothingIsPressed) {
  show();
  aim_at(kPanel_m + Vector3f(0.0f, 0.05f, 0.0f));
  press();
  EXPECT_TRUE(panel_.pointer());
  aim_at(kPanel_m + Vector3f(0.3f, 0.0f, 0.0f));
  press();
  EXPECT_FALSE(panel_.pointer());
  input_.right_aim_W = ray({0.3f, 1.2f, -0.1f}, {0.5f, 1.2f, 1.0f});
  press();
  input_.right_aim_W.reset();
  press();
  EXPECT_EQ(presses(), 0);
}

TEST_F(WristPanelTest, FromBehindItCannotBePointedAt) {
  show();
  input_.right_aim_W = ray({0.1f, 1.5f, -0.8f}, point_on(PanelAction::kMute));
  press();
  EXPECT_FALSE(panel_.pointer());
  EXPECT_EQ(presses(), 0);
}

TEST_F(WristPanelTest, APressThatBeganElsewhereIsNoneHere) {
  show();
  aim_at(kPanel_m + Vector3f(0.3f, 0.0f, 0.0f));
  input_.is_pressed = true;
  turn(Duration::ms(100));
  aim_at(point_on(PanelAction::kMute));
  turn(Duration::ms(100));
  // Where the hand is not tracked for a moment, and away from the plane of the panel, too.
  input_.right_aim_W.reset();
  turn();
  aim_at(point_on(PanelAction::kMute));
  turn();
  input_.right_aim_W = ray({0.3f, 1.2f, -0.1f}, {0.5f, 1.2f, 1.0f});
  turn(Duration::ms(100));
  aim_at(point_on(PanelAction::kRecentre));
  turn(Duration::ms(100));
  EXPECT_EQ(presses(), 0);
}

TEST_F(WristPanelTest, ATriggerThatIsHeldWhenThePanelAppearsPressesNothing) {
  const auto facing = input_.left_grip_W;
  input_.left_grip_W = grip_for({0.0f, 1.6f, 0.3f});
  aim_at(point_on(PanelAction::kRecentre));
  input_.is_pressed = true;
  turn(Duration::s(1));
  input_.left_grip_W = facing;
  turn(Duration::s(1));
  EXPECT_TRUE(panel_.pointer());
  EXPECT_EQ(presses(), 0) << "a hand that happens to be turned in the dance";
  input_.is_pressed = false;
  turn();
  press();
  EXPECT_EQ(pressed_[PanelAction::kRecentre], 1);
}

TEST_F(WristPanelTest, LeavingWantsItsButtonHeld) {
  show();
  aim_at(point_on(PanelAction::kLeave));
  press(Duration::ms(700));
  EXPECT_EQ(presses(), 0);
  EXPECT_EQ(panel_.held(PanelAction::kLeave), 0.0f);
  input_.is_pressed = true;
  turn(Duration::ms(450));
  EXPECT_NEAR(panel_.held(PanelAction::kLeave), 0.5f, 0.03f);
  EXPECT_EQ(panel_.held(PanelAction::kMute), 0.0f);
  // The hand slips: it begins anew.
  aim_at(point_on(PanelAction::kMute));
  turn();
  EXPECT_EQ(panel_.held(PanelAction::kLeave), 0.0f);
  aim_at(point_on(PanelAction::kLeave));
  turn(Duration::s(2));
  EXPECT_EQ(presses(), 0) << "it was not pressed there";
  input_.is_pressed = false;
  turn();
  press(Duration::s(3));
  EXPECT_EQ(pressed_[PanelAction::kLeave], 1);
  EXPECT_EQ(presses(), 1);
}

TEST_F(WristPanelTest, AFingertipPressesByTouching) {
  show();
  const Vector3f button = point_on(PanelAction::kCalibrate);
  const auto finger_before = [&](float distance_m) {
    input_.fingertip_W_m = button + Vector3f(0.0f, 0.0f, distance_m);
    turn(Duration::ms(100));
  };
  finger_before(0.2f);
  EXPECT_FALSE(panel_.pointer());
  finger_before(0.03f);
  ASSERT_TRUE(panel_.hovered()) << "near, it shows what it would press";
  EXPECT_EQ(*panel_.hovered(), PanelAction::kCalibrate);
  EXPECT_EQ(presses(), 0);
  finger_before(0.005f);
  finger_before(-0.02f);
  EXPECT_EQ(pressed_[PanelAction::kCalibrate], 1);
  finger_before(0.03f);
  finger_before(0.0f);
  EXPECT_EQ(pressed_[PanelAction::kCalibrate], 2);
  EXPECT_EQ(presses(), 2);
}

TEST_F(WristPanelTest, ABareHandThatIsFarPressesByAPinch) {
  show();
  input_.fingertip_W_m = Vector3f(0.3f, 1.2f, -0.1f);
  aim_at(point_on(PanelAction::kMute));
  turn(Duration::ms(100));
  EXPECT_EQ(presses(), 0);
  press();
  EXPECT_EQ(pressed_[PanelAction::kMute], 1);
}

TEST_F(WristPanelTest, AFingertipThatGoesThroughThePanelAndComesBackPressesOnce) {
  show();
  const Vector3f button = point_on(PanelAction::kMute);
  for (const float distance_m : {0.04f, 0.0f, -0.04f, -0.08f, -0.04f, 0.0f, 0.04f}) {
    input_.fingertip_W_m = button + Vector3f(0.0f, 0.0f, distance_m);
    turn(Duration::ms(30));
  }
  EXPECT_EQ(pressed_[PanelAction::kMute], 1);
  // From the side, within the panel.
  for (const float aside_m : {0.3f, 0.2f, 0.1f, 0.0f}) {
    input_.fingertip_W_m = button + Vector3f(-aside_m, 0.0f, 0.0f);
    turn(Duration::ms(30));
  }
  EXPECT_EQ(presses(), 1);
}

TEST_F(WristPanelTest, WhatIsHiddenIsNotPressed) {
  input_.left_grip_W = grip_for({0.0f, 1.6f, -0.9f});
  input_.right_aim_W = ray({0.3f, 1.2f, -0.1f}, {0.0f, 1.58f, -0.9f});
  for (int i = 0; i < 5; ++i) press(Duration::s(2));
  EXPECT_EQ(presses(), 0);
  EXPECT_FALSE(panel_.hovered());
}

}  // namespace
}  // namespace dance
