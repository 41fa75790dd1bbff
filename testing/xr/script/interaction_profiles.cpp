#include "testing/xr/script/interaction_profiles.h"

#include <array>

namespace dance::test_xr {
namespace {

struct ProfilePaths {
  std::string_view name;
  bool is_of_trackers;
  std::string_view both;  // of both hands: words
  std::string_view left;
  std::string_view right;
};

constexpr std::array<ProfilePaths, 6> kProfiles{{
    {"/interaction_profiles/khr/simple_controller", false,
     "input/select/click input/menu/click input/grip/pose input/aim/pose output/haptic", "", ""},
    {"/interaction_profiles/oculus/touch_controller", false,
     "input/squeeze/value input/trigger/value input/trigger/touch input/thumbstick/x "
     "input/thumbstick/y input/thumbstick/click input/thumbstick/touch input/thumbrest/touch "
     "input/grip/pose input/aim/pose output/haptic",
     "input/x/click input/x/touch input/y/click input/y/touch input/menu/click",
     "input/a/click input/a/touch input/b/click input/b/touch input/system/click"},
    {"/interaction_profiles/valve/index_controller", false,
     "input/system/click input/system/touch input/a/click input/a/touch input/b/click "
     "input/b/touch input/squeeze/value input/squeeze/force input/trigger/click "
     "input/trigger/value input/trigger/touch input/thumbstick/x input/thumbstick/y "
     "input/thumbstick/click input/thumbstick/touch input/trackpad/x input/trackpad/y "
     "input/trackpad/force input/trackpad/touch input/grip/pose input/aim/pose output/haptic",
     "", ""},
    {"/interaction_profiles/htc/vive_controller", false,
     "input/system/click input/squeeze/click input/menu/click input/trigger/click "
     "input/trigger/value input/trackpad/x input/trackpad/y input/trackpad/click "
     "input/trackpad/touch input/grip/pose input/aim/pose output/haptic",
     "", ""},
    {"/interaction_profiles/microsoft/motion_controller", false,
     "input/menu/click input/squeeze/click input/trigger/value input/thumbstick/x "
     "input/thumbstick/y input/thumbstick/click input/trackpad/x input/trackpad/y "
     "input/trackpad/click input/trackpad/touch input/grip/pose input/aim/pose output/haptic",
     "", ""},
    {"/interaction_profiles/htc/vive_tracker_htcx", true,
     "input/system/click input/menu/click input/trigger/click input/trigger/value "
     "input/squeeze/click input/trackpad/x input/trackpad/y input/trackpad/click "
     "input/trackpad/touch input/grip/pose output/haptic",
     "", ""},
}};

bool has_word(std::string_view words, std::string_view word) {
  while (!words.empty()) {
    const std::string_view first = words.substr(0, words.find(' '));
    const bool is_parent = first.starts_with(word) && first.size() > word.size() &&
                           first[word.size()] == '/' && word.find('/') != std::string_view::npos;
    if (first == word || is_parent) return true;
    words.remove_prefix(first.size());
    if (!words.empty()) words.remove_prefix(1);
  }
  return false;
}

const ProfilePaths* find_profile(std::string_view name) {
  for (const ProfilePaths& profile : kProfiles)
    if (profile.name == name) return &profile;
  return nullptr;
}

}  // namespace

bool is_known_profile(std::string_view profile) { return find_profile(profile) != nullptr; }

bool has_profile_path(std::string_view profile, std::string_view top, std::string_view path) {
  const ProfilePaths* found = find_profile(profile);
  if (!found || path.size() <= top.size() + 1) return false;
  const bool is_left = top == "/user/hand/left";
  const bool is_right = top == "/user/hand/right";
  if (found->is_of_trackers != top.starts_with("/user/vive_tracker_htcx/role/")) return false;
  if (!found->is_of_trackers && !is_left && !is_right) return false;
  const std::string_view rest = path.substr(top.size() + 1);
  return has_word(found->both, rest) || (is_left && has_word(found->left, rest)) ||
         (is_right && has_word(found->right, rest));
}

}  // namespace dance::test_xr
