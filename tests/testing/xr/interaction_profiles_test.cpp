#include "testing/xr/script/interaction_profiles.h"

#include <gtest/gtest.h>

namespace dance::test_xr {
namespace {

constexpr const char* kTouch = "/interaction_profiles/oculus/touch_controller";

TEST(InteractionProfiles, KnowWhatEachHandHas) {
  EXPECT_TRUE(is_known_profile(kTouch));
  EXPECT_FALSE(is_known_profile("/interaction_profiles/oculus/go"));
  EXPECT_TRUE(has_profile_path(kTouch, "/user/hand/left", "/user/hand/left/input/x/click"));
  EXPECT_FALSE(has_profile_path(kTouch, "/user/hand/right", "/user/hand/right/input/x/click"));
  EXPECT_TRUE(has_profile_path(kTouch, "/user/hand/right", "/user/hand/right/input/thumbstick"));
  EXPECT_FALSE(has_profile_path(kTouch, "/user/hand/right", "/user/hand/right/input"));
  EXPECT_FALSE(has_profile_path(kTouch, "/user/hand/left", "/user/hand/left/input/trigger/click"));
}

TEST(InteractionProfiles, KeepTrackersAndHandsApart) {
  constexpr const char* kTracker = "/interaction_profiles/htc/vive_tracker_htcx";
  constexpr const char* kWaist = "/user/vive_tracker_htcx/role/waist";
  EXPECT_TRUE(has_profile_path(kTracker, kWaist, std::string(kWaist) + "/input/grip/pose"));
  EXPECT_FALSE(has_profile_path(kTracker, kWaist, std::string(kWaist) + "/input/aim/pose"));
  EXPECT_FALSE(has_profile_path(kTouch, kWaist, std::string(kWaist) + "/input/grip/pose"));
  EXPECT_FALSE(has_profile_path(kTracker, "/user/hand/left", "/user/hand/left/input/grip/pose"));
}

}  // namespace
}  // namespace dance::test_xr
