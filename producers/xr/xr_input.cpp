#include "producers/xr/xr_input.h"

#include <cmath>
#include <cstring>

namespace dance {
namespace {

constexpr std::array<const char*, kXrHands> kHandPaths{"/user/hand/left", "/user/hand/right"};
constexpr XrPosef kAsItIs{{0.0f, 0.0f, 0.0f, 1.0f}, {0.0f, 0.0f, 0.0f}};

struct Role {
  TrackedPoint point;
  const char* path;
};
constexpr std::array<Role, 8> kRoles{{
    {TrackedPoint::kHips, "/user/vive_tracker_htcx/role/waist"},
    {TrackedPoint::kLeftFoot, "/user/vive_tracker_htcx/role/left_foot"},
    {TrackedPoint::kRightFoot, "/user/vive_tracker_htcx/role/right_foot"},
    {TrackedPoint::kLeftElbow, "/user/vive_tracker_htcx/role/left_elbow"},
    {TrackedPoint::kRightElbow, "/user/vive_tracker_htcx/role/right_elbow"},
    {TrackedPoint::kLeftKnee, "/user/vive_tracker_htcx/role/left_knee"},
    {TrackedPoint::kRightKnee, "/user/vive_tracker_htcx/role/right_knee"},
    {TrackedPoint::kChest, "/user/vive_tracker_htcx/role/chest"},
}};

std::size_t index_of(XrHand hand) { return static_cast<std::size_t>(hand); }

// Whether the runtime says that there is a place.
bool is_told(XrSpaceLocationFlags flags, bool must_be_tracked) {
  constexpr XrSpaceLocationFlags kValid =
      XR_SPACE_LOCATION_POSITION_VALID_BIT | XR_SPACE_LOCATION_ORIENTATION_VALID_BIT;
  const XrSpaceLocationFlags wanted =
      kValid | (must_be_tracked ? XR_SPACE_LOCATION_POSITION_TRACKED_BIT : 0);
  return (flags & wanted) == wanted;
}

}  // namespace

std::optional<XrPlace> place_of(XrSpaceLocationFlags flags, const XrPosef& pose,
                                bool must_be_tracked) {
  if (!is_told(flags, must_be_tracked)) return std::nullopt;
  const XrVector3f& p = pose.position;
  const XrQuaternionf& R = pose.orientation;
  XrPlace place{{p.x, p.y, p.z}, {R.w, R.x, R.y, R.z}};
  // A runtime's numbers come from outside, as bytes of the net do.
  if (!place.p_m.allFinite() || place.p_m.norm() > kMostBaseDistance_m) return std::nullopt;
  if (!(std::abs(place.R.norm() - 1.0f) <= 0.01f)) return std::nullopt;
  place.R.normalize();
  return place;
}

Result<std::unique_ptr<XrInput>> XrInput::create(const XrDancerSession& session) {
  std::unique_ptr<XrInput> input(new XrInput(session));
  if (auto opened = input->open(); !opened) return tl::make_unexpected(opened.error());
  return input;
}

XrInput::~XrInput() {
  for (const XrSpace space : grips_)
    if (space != XR_NULL_HANDLE) xrDestroySpace(space);
  for (const XrSpace space : aims_)
    if (space != XR_NULL_HANDLE) xrDestroySpace(space);
  for (const Tracker& tracker : trackers_)
    if (tracker.space != XR_NULL_HANDLE) xrDestroySpace(tracker.space);
  if (set_ != XR_NULL_HANDLE) xrDestroyActionSet(set_);
}

Result<void> XrInput::open() {
  XrActionSetCreateInfo info{};
  info.type = XR_TYPE_ACTION_SET_CREATE_INFO;
  std::strncpy(info.actionSetName, "dance", XR_MAX_ACTION_SET_NAME_SIZE - 1);
  std::strncpy(info.localizedActionSetName, "Dance", XR_MAX_LOCALIZED_ACTION_SET_NAME_SIZE - 1);
  if (auto made = checked(xrCreateActionSet(session_.runtime().instance(), &info, &set_),
                          "a set of actions");
      !made)
    return made;
  for (std::size_t i = 0; i < kXrHands; ++i) {
    DANCE_TRY(hands_[i], path(kHandPaths[i]));
  }
  DANCE_TRY(grip_, action("grip", "Hand", XR_ACTION_TYPE_POSE_INPUT, true));
  DANCE_TRY(aim_, action("aim", "Pointing", XR_ACTION_TYPE_POSE_INPUT, true));
  DANCE_TRY(press_, action("press", "Press", XR_ACTION_TYPE_BOOLEAN_INPUT, true));
  DANCE_TRY(menu_, action("menu", "Panel", XR_ACTION_TYPE_BOOLEAN_INPUT, true));
  DANCE_TRY(haptic_, action("felt", "Touch and beat", XR_ACTION_TYPE_VIBRATION_OUTPUT, true));
  if (auto opened = open_trackers(); !opened) return opened;
  if (auto suggested = suggest_all(); !suggested) return suggested;
  XrSessionActionSetsAttachInfo attach{};
  attach.type = XR_TYPE_SESSION_ACTION_SETS_ATTACH_INFO;
  attach.countActionSets = 1;
  attach.actionSets = &set_;
  if (auto attached =
          checked(xrAttachSessionActionSets(session_.handle(), &attach), "the set of actions");
      !attached)
    return attached;
  return make_spaces();
}

Result<XrPath> XrInput::path(const std::string& text) const {
  XrPath path = XR_NULL_PATH;
  if (auto made =
          checked(xrStringToPath(session_.runtime().instance(), text.c_str(), &path), text.c_str());
      !made)
    return tl::make_unexpected(made.error());
  return path;
}

Result<XrAction> XrInput::action(const char* name, const char* title, XrActionType type,
                                 bool is_of_hands) {
  std::vector<XrPath> paths(hands_.begin(), hands_.end());
  if (!is_of_hands) {
    paths.clear();
    for (std::size_t i = 0; i < tracker_count_; ++i) paths.push_back(trackers_[i].path);
  }
  XrActionCreateInfo info{};
  info.type = XR_TYPE_ACTION_CREATE_INFO;
  std::strncpy(info.actionName, name, XR_MAX_ACTION_NAME_SIZE - 1);
  std::strncpy(info.localizedActionName, title, XR_MAX_LOCALIZED_ACTION_NAME_SIZE - 1);
  info.actionType = type;
  info.countSubactionPaths = static_cast<std::uint32_t>(paths.size());
  info.subactionPaths = paths.data();
  XrAction action = XR_NULL_HANDLE;
  if (auto made = checked(xrCreateAction(set_, &info, &action), title); !made)
    return tl::make_unexpected(made.error());
  return action;
}

Result<void> XrInput::open_trackers() {
  if (!session_.runtime().has(XR_HTCX_VIVE_TRACKER_INTERACTION_EXTENSION_NAME)) return {};
  for (const Role& role : kRoles) {
    DANCE_TRY(const XrPath role_path, path(role.path));
    trackers_[tracker_count_++] = {role.point, role_path, XR_NULL_HANDLE};
  }
  DANCE_TRY(worn_, action("worn", "Trackers", XR_ACTION_TYPE_POSE_INPUT, false));
  return {};
}

Result<XrSpace> XrInput::space_of(XrAction action, XrPath subaction) const {
  XrActionSpaceCreateInfo info{};
  info.type = XR_TYPE_ACTION_SPACE_CREATE_INFO;
  info.action = action;
  info.subactionPath = subaction;
  info.poseInActionSpace = kAsItIs;
  XrSpace space = XR_NULL_HANDLE;
  if (auto made = checked(xrCreateActionSpace(session_.handle(), &info, &space), "a space"); !made)
    return tl::make_unexpected(made.error());
  return space;
}

Result<void> XrInput::make_spaces() {
  for (std::size_t i = 0; i < kXrHands; ++i) {
    DANCE_TRY(grips_[i], space_of(grip_, hands_[i]));
    DANCE_TRY(aims_[i], space_of(aim_, hands_[i]));
  }
  for (std::size_t i = 0; i < tracker_count_; ++i) {
    DANCE_TRY(trackers_[i].space, space_of(worn_, trackers_[i].path));
  }
  return {};
}

bool XrInput::suggest(const char* profile,
                      const std::vector<std::pair<XrAction, std::string>>& bindings) const {
  const auto profile_path = path(std::string("/interaction_profiles/") + profile);
  if (!profile_path) return false;
  std::vector<XrActionSuggestedBinding> suggested;
  for (const auto& [action, where] : bindings) {
    const auto binding = path(where);
    if (!binding) return false;
    suggested.push_back({action, *binding});
  }
  XrInteractionProfileSuggestedBinding info{};
  info.type = XR_TYPE_INTERACTION_PROFILE_SUGGESTED_BINDING;
  info.interactionProfile = *profile_path;
  info.countSuggestedBindings = static_cast<std::uint32_t>(suggested.size());
  info.suggestedBindings = suggested.data();
  return XR_SUCCEEDED(xrSuggestInteractionProfileBindings(session_.runtime().instance(), &info));
}

#define DANCE_XR_HANDS(action, input) \
  {action, "/user/hand/left" input}, { action, "/user/hand/right" input }

Result<void> XrInput::suggest_all() const {
  // Runtimes refuse profiles that they do not know, and remap what is missing.
  int taken = 0;
  taken += suggest(
      "khr/simple_controller",
      {DANCE_XR_HANDS(grip_, "/input/grip/pose"), DANCE_XR_HANDS(aim_, "/input/aim/pose"),
       DANCE_XR_HANDS(press_, "/input/select/click"), DANCE_XR_HANDS(menu_, "/input/menu/click"),
       DANCE_XR_HANDS(haptic_, "/output/haptic")});
  taken += suggest("oculus/touch_controller", {DANCE_XR_HANDS(grip_, "/input/grip/pose"),
                                               DANCE_XR_HANDS(aim_, "/input/aim/pose"),
                                               DANCE_XR_HANDS(press_, "/input/trigger/value"),
                                               {menu_, "/user/hand/left/input/menu/click"},
                                               {menu_, "/user/hand/right/input/b/click"},
                                               DANCE_XR_HANDS(haptic_, "/output/haptic")});
  taken +=
      suggest("valve/index_controller",
              {DANCE_XR_HANDS(grip_, "/input/grip/pose"), DANCE_XR_HANDS(aim_, "/input/aim/pose"),
               DANCE_XR_HANDS(press_, "/input/trigger/click"),
               DANCE_XR_HANDS(menu_, "/input/b/click"), DANCE_XR_HANDS(haptic_, "/output/haptic")});
  taken += suggest(
      "htc/vive_controller",
      {DANCE_XR_HANDS(grip_, "/input/grip/pose"), DANCE_XR_HANDS(aim_, "/input/aim/pose"),
       DANCE_XR_HANDS(press_, "/input/trigger/click"), DANCE_XR_HANDS(menu_, "/input/menu/click"),
       DANCE_XR_HANDS(haptic_, "/output/haptic")});
  taken += suggest(
      "microsoft/motion_controller",
      {DANCE_XR_HANDS(grip_, "/input/grip/pose"), DANCE_XR_HANDS(aim_, "/input/aim/pose"),
       DANCE_XR_HANDS(press_, "/input/trigger/value"), DANCE_XR_HANDS(menu_, "/input/menu/click"),
       DANCE_XR_HANDS(haptic_, "/output/haptic")});
  if (taken == 0)
    return fail("the headset's runtime takes none of the controllers that are known here");
  if (tracker_count_ > 0) {
    std::vector<std::pair<XrAction, std::string>> worn;
    for (const Role& role : kRoles)
      worn.emplace_back(worn_, std::string(role.path) + "/input/grip/pose");
    suggest("htc/vive_tracker_htcx", worn);
  }
  return {};
}

#undef DANCE_XR_HANDS

void XrInput::sync() {
  if (!session_.is_running()) return;
  const XrActiveActionSet active{set_, XR_NULL_PATH};
  XrActionsSyncInfo info{};
  info.type = XR_TYPE_ACTIONS_SYNC_INFO;
  info.countActiveActionSets = 1;
  info.activeActionSets = &active;
  // Where it fails nothing is active.
  if (XR_FAILED(xrSyncActions(session_.handle(), &info))) ++refused_;
}

std::optional<XrPlace> XrInput::locate(XrSpace space, XrTime time, bool must_be_tracked) const {
  if (space == XR_NULL_HANDLE || time <= 0) return std::nullopt;
  XrSpaceLocation location{};
  location.type = XR_TYPE_SPACE_LOCATION;
  if (XR_FAILED(xrLocateSpace(space, session_.base(), time, &location))) {
    ++refused_;
    return std::nullopt;
  }
  const auto place = place_of(location, must_be_tracked);
  if (!place && is_told(location.locationFlags, must_be_tracked)) ++bad_places_;
  return place;
}

std::optional<XrPlace> XrInput::head(XrTime time) const {
  return locate(session_.view(), time, false);
}
std::optional<XrPlace> XrInput::grip(XrHand hand, XrTime time) const {
  return locate(grips_[index_of(hand)], time, true);
}
std::optional<XrPlace> XrInput::aim(XrHand hand, XrTime time) const {
  return locate(aims_[index_of(hand)], time, true);
}

std::optional<XrPlace> XrInput::tracker(TrackedPoint point, XrTime time) const {
  for (std::size_t i = 0; i < tracker_count_; ++i)
    if (trackers_[i].point == point) return locate(trackers_[i].space, time, true);
  return std::nullopt;
}

XrActionStateGetInfo XrInput::state_info(XrAction action, XrHand hand) const {
  XrActionStateGetInfo info{};
  info.type = XR_TYPE_ACTION_STATE_GET_INFO;
  info.action = action;
  info.subactionPath = hands_[index_of(hand)];
  return info;
}

bool XrInput::state_of(XrAction action, XrHand hand) const {
  const XrActionStateGetInfo info = state_info(action, hand);
  XrActionStateBoolean state{};
  state.type = XR_TYPE_ACTION_STATE_BOOLEAN;
  return XR_SUCCEEDED(xrGetActionStateBoolean(session_.handle(), &info, &state)) &&
         state.isActive == XR_TRUE && state.currentState == XR_TRUE;
}

bool XrInput::holds(XrHand hand) const {
  const XrActionStateGetInfo info = state_info(grip_, hand);
  XrActionStatePose state{};
  state.type = XR_TYPE_ACTION_STATE_POSE;
  return XR_SUCCEEDED(xrGetActionStatePose(session_.handle(), &info, &state)) &&
         state.isActive == XR_TRUE;
}

bool XrInput::is_pressed(XrHand hand) const { return state_of(press_, hand); }
bool XrInput::is_menu_pressed(XrHand hand) const { return state_of(menu_, hand); }

XrHapticActionInfo XrInput::haptic_info(XrHand hand) const {
  XrHapticActionInfo info{};
  info.type = XR_TYPE_HAPTIC_ACTION_INFO;
  info.action = haptic_;
  info.subactionPath = hands_[index_of(hand)];
  return info;
}

bool XrInput::vibrate(XrHand hand, float amplitude, Duration duration, float frequency_hz) const {
  const XrHapticActionInfo info = haptic_info(hand);
  XrHapticVibration vibration{};
  vibration.type = XR_TYPE_HAPTIC_VIBRATION;
  vibration.duration = duration.count_ns();
  vibration.frequency = frequency_hz;  // 0: the device's own
  vibration.amplitude = amplitude;
  const auto* header = reinterpret_cast<const XrHapticBaseHeader*>(&vibration);
  // Neither fails nor is felt while the session has no focus.
  return xrApplyHapticFeedback(session_.handle(), &info, header) == XR_SUCCESS;
}

void XrInput::stop(XrHand hand) const {
  const XrHapticActionInfo info = haptic_info(hand);
  xrStopHapticFeedback(session_.handle(), &info);
}

}  // namespace dance
