#include "testing/xr/script/xr_script.h"

#include <gtest/gtest.h>

#include <cmath>

#include "testing/xr/script/body_skeleton.h"
#include "testing/xr/script/hand_skeleton.h"
#include "testing/xr/script/xr_scene.h"

namespace dance::test_xr {
namespace {

XrScript parse(const char* text) {
  auto script = parse_script(text, "script", ".");
  EXPECT_TRUE(script.has_value()) << script.error().what;
  return script ? *script : XrScript();
}

std::string error_of(const char* text) {
  const auto script = parse_script(text, "script", ".");
  return script ? "" : script.error().what;
}

TEST(XrScript, ReadsEverySetting) {
  const XrScript script = parse(
      "# a headset\n"
      "refresh 72\nfov -40 50 44 -46\nsize 100 200\npictures 10\n"
      "without XR_EXT_hand_tracking\nsystem hands off\nbody on\nno stage\n"
      "no system until 2.5\nprofile valve/index_controller\n");
  EXPECT_EQ(script.refresh_hz, 72.0);
  EXPECT_EQ(script.fov_deg[1], 50.0);
  EXPECT_EQ(script.size_px[1], 200);
  EXPECT_EQ(script.pictures_every, 10);
  ASSERT_EQ(script.without.size(), 1u);
  EXPECT_FALSE(script.has_hands);
  EXPECT_TRUE(script.has_body);
  EXPECT_FALSE(script.has_stage);
  EXPECT_EQ(script.no_system_until_s, 2.5);
  EXPECT_EQ(script.profile, "/interaction_profiles/valve/index_controller");
}

TEST(XrScript, InterpolatesKeyframesAndHoldsThemOutside) {
  const XrScript script = parse(
      "at 2 pose head 0 1.7 -2 0 0.70710678 0 0.70710678  # later first: they are sorted\n"
      "at 1 pose head 0 1.7 0 0 0 0 1\n");
  EXPECT_NEAR(point_at(script, TrackedPoint::kHead, 0.0).p_m.z(), 0.0, 1e-9);
  const PointState middle = point_at(script, TrackedPoint::kHead, 1.5);
  EXPECT_NEAR(middle.p_m.z(), -1.0, 1e-9);
  EXPECT_NEAR(middle.R.angularDistance(Eigen::Quaterniond::Identity()), M_PI / 4.0, 1e-6);
  EXPECT_NEAR(middle.v_mps.z(), -2.0, 1e-6);
  EXPECT_NEAR(middle.w_radps.y(), M_PI / 2.0, 1e-6);
  EXPECT_NEAR(point_at(script, TrackedPoint::kHead, 9.0).p_m.z(), -2.0, 1e-9);
}

TEST(XrScript, LosesGuessesAndFindsPoints) {
  const XrScript script = parse(
      "at 1 lose left-hand\nat 2 guess left-hand\nat 3 find left-hand\nat 4 nan left-hand\n"
      "at 1 pose hips 0 1 0 0 0 0 1\n");
  const auto hand = [&](double t_s) { return point_at(script, TrackedPoint::kLeftHand, t_s); };
  EXPECT_EQ(hand(0.9).tracking, Tracking::kTracked);
  EXPECT_EQ(hand(1.0).tracking, Tracking::kLost);
  EXPECT_EQ(hand(2.5).tracking, Tracking::kGuessed);
  EXPECT_EQ(hand(3.5).tracking, Tracking::kTracked);
  EXPECT_TRUE(std::isnan(hand(4.1).p_m.x()));
  EXPECT_TRUE(hand(4.3).p_m.allFinite());
  EXPECT_EQ(point_at(script, TrackedPoint::kHips, 0.5).tracking, Tracking::kLost);
  EXPECT_EQ(point_at(script, TrackedPoint::kHips, 1.5).tracking, Tracking::kTracked);
}

TEST(XrScript, PressesAndReleasesInputs) {
  const XrScript script = parse(
      "at 1 press left trigger 0.5\nat 1 press right thumbstick -0.25 0.75\n"
      "at 2 release left trigger\nat 2 hands fist\n");
  EXPECT_EQ(input_at(script, Hand::kLeft, Input::kTrigger, 0.5)[0], 0.0f);
  EXPECT_EQ(input_at(script, Hand::kLeft, Input::kTrigger, 1.5)[0], 0.5f);
  EXPECT_EQ(input_at(script, Hand::kLeft, Input::kTrigger, 2.5)[0], 0.0f);
  EXPECT_EQ(input_at(script, Hand::kRight, Input::kThumbstick, 1.5)[1], 0.75f);
  EXPECT_FALSE(is_fist_at(script, 1.5));
  EXPECT_TRUE(is_fist_at(script, 2.5));
}

TEST(XrScript, SortsItsEvents) {
  const XrScript script = parse(
      "at 5 exit\nat 1 focus off\nat 2 bad_time past\nat 3 jump 1 0 0 90\n"
      "at 4 fail xrEndFrame XR_ERROR_RUNTIME_FAILURE\n");
  ASSERT_EQ(script.events.size(), 5u);
  EXPECT_EQ(script.events[0].kind, EventKind::kFocus);
  EXPECT_FALSE(script.events[0].is_on);
  EXPECT_EQ(script.events[1].word, "past");
  EXPECT_EQ(script.events[3].result, -2);
  EXPECT_EQ(script.events[4].kind, EventKind::kExit);
}

TEST(XrScript, NamesTheLineAndTheCureOfWhatIsWrong) {
  EXPECT_NE(error_of("refresh 90\nrefresh fast\n").find("script:2: 'fast' is not a number"),
            std::string::npos);
  EXPECT_NE(error_of("dance\n").find("'dance' begins no line"), std::string::npos);
  EXPECT_NE(error_of("at 1 pose nose 0 0 0 0 0 0 1\n").find("'nose' is no point"),
            std::string::npos);
  EXPECT_NE(error_of("at 1 pose head 0 0 0 0 0 0 2\n").find("length 1"), std::string::npos);
  EXPECT_NE(error_of("at -1 exit\n").find("0 seconds or more"), std::string::npos);
  EXPECT_NE(error_of("at 1 press left nose\n").find("'nose' is no input"), std::string::npos);
  EXPECT_NE(error_of("at 1 fail xrEndFrame XR_OOPS\n").find("'XR_OOPS'"), std::string::npos);
  EXPECT_NE(error_of("at 1 sing\n").find("'sing' happens never"), std::string::npos);
  EXPECT_NE(error_of("motion nowhere.csv\n").find("beside the script"), std::string::npos);
  for (const char* line : {"fov 1 2 3",
                           "fov 50 -42 45 -48",
                           "size 0 1",
                           "pictures 0",
                           "no",
                           "no stage until",
                           "system hands",
                           "system hands maybe",
                           "without hands",
                           "profile touch",
                           "at",
                           "at 1",
                           "at x exit",
                           "at 1 exit now",
                           "at 1 focus",
                           "at 1 lose",
                           "at 1 lose head again",
                           "at 1 press",
                           "at 1 press left trigger 2",
                           "at 1 release left trigger 1",
                           "at 1 hands open",
                           "at 1 jump 1 2 3",
                           "at 1 bad_time late",
                           "at 1 fail EndFrame X",
                           "refresh 1e9",
                           "at nan exit"})
    EXPECT_NE(error_of(line).find("script:1: "), std::string::npos) << line;
}

// OpenXR: fingers are along -Z of the palm, +Y leaves the back of the hand, thumbs point forward.
TEST(HandSkeleton, HangsBesideTheThighs) {
  for (const Hand hand : {Hand::kLeft, Hand::kRight}) {
    const HandSkeleton flat = hand_skeleton(hand, false);
    const double outwards = hand == Hand::kLeft ? -1.0 : 1.0;
    EXPECT_NEAR(flat.T_GJ[0].linear().determinant(), 1.0, 1e-9);
    EXPECT_NEAR(flat.T_GJ[0].linear().col(1).x(), outwards, 1e-9);
    const auto at = [&](std::size_t joint) { return flat.T_GJ[joint].translation(); };
    EXPECT_LT(at(15).y(), at(1).y() - 0.1) << "the middle finger's tip is below the wrist";
    EXPECT_LT(at(5).z(), at(1).z() - 0.03) << "the thumb is in front";
    EXPECT_LT(at(10).z(), at(25).z()) << "the index finger is before the little one";
    const HandSkeleton fist = hand_skeleton(hand, true);
    EXPECT_GT(fist.T_GJ[15].translation().y(), at(15).y() + 0.05);
    EXPECT_LT(outwards * fist.T_GJ[13].translation().x(), outwards * at(13).x());
  }
}

TEST(BodySkeleton, HasAllJointsAndStandsUpright) {
  const XrScript script = default_script();
  const auto full = full_body(script, 0.0);
  ASSERT_EQ(full.size(), 84u);
  EXPECT_NEAR(full[7].translation().y(), 1.65, 1e-9);
  EXPECT_LT(full[12].translation().x(), full[17].translation().x());
  EXPECT_LT(full[83].translation().y(), 0.1);
  EXPECT_EQ(small_body(script, 0.0).size(), 24u);
}

}  // namespace
}  // namespace dance::test_xr
