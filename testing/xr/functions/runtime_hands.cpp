// XR_EXT_hand_tracking: the joints of both hands.
#include "testing/xr/functions/runtime_functions.h"
#include "testing/xr/script/hand_skeleton.h"
#include "testing/xr/state/runtime_call.h"
#include "testing/xr/state/runtime_poses.h"

namespace dance::test_xr {
namespace {

static_assert(kHandJoints == XR_HAND_JOINT_COUNT_EXT);

XrResult XRAPI_CALL create_hand(XrSession session, const XrHandTrackerCreateInfoEXT* info,
                                XrHandTrackerEXT* tracker) {
  XrCall call("xrCreateHandTrackerEXT");
  if (call.early()) return *call.early();
  if (!call.session(session) || !call.is_fine(info, XR_TYPE_HAND_TRACKER_CREATE_INFO_EXT))
    return call.result();
  if (!runtime().script.has_hands)
    return call.wrong(XR_ERROR_FEATURE_UNSUPPORTED, "the system does not track hands");
  const bool is_left = info->hand == XR_HAND_LEFT_EXT;
  if (!is_left && info->hand != XR_HAND_RIGHT_EXT)
    return call.wrong(XR_ERROR_VALIDATION_FAILURE, "neither left nor right");
  if (info->handJointSet != XR_HAND_JOINT_SET_DEFAULT_EXT)
    return call.wrong(XR_ERROR_VALIDATION_FAILURE, "another set of joints than the default");
  auto made = std::make_unique<HandTracker>();
  made->session = session;
  made->hand = is_left ? Hand::kLeft : Hand::kRight;
  *tracker = runtime().hand_trackers.add(std::move(made));
  return XR_SUCCESS;
}

XrResult XRAPI_CALL destroy_hand(XrHandTrackerEXT tracker) {
  XrCall call("xrDestroyHandTrackerEXT");
  if (!runtime().hand_trackers.remove(tracker))
    return call.wrong(XR_ERROR_HANDLE_INVALID, "the hand tracker is not alive");
  return XR_SUCCESS;
}

bool is_fine_hand(XrCall& call, const XrHandJointsLocateInfoEXT* info,
                  const XrHandJointLocationsEXT* locations) {
  if (!call.is_fine(info, XR_TYPE_HAND_JOINTS_LOCATE_INFO_EXT) ||
      !call.is_fine(locations, XR_TYPE_HAND_JOINT_LOCATIONS_EXT,
                    {XR_TYPE_HAND_JOINT_VELOCITIES_EXT}) ||
      !call.is_fine_time(info->time))
    return false;
  if (locations->jointCount == kHandJoints && locations->jointLocations) return true;
  call.set_result(call.wrong(XR_ERROR_VALIDATION_FAILURE, "not 26 joints"));
  return false;
}

void fill_velocities(const Located& from, const Located& hand, XrHandJointLocationsEXT& locations) {
  auto* velocities =
      find_next<XrHandJointVelocitiesEXT>(locations.next, XR_TYPE_HAND_JOINT_VELOCITIES_EXT);
  if (!velocities || !velocities->jointVelocities) return;
  const Eigen::Vector3f v =
      (from.state.R.conjugate() * (hand.state.v_mps - from.state.v_mps)).cast<float>();
  for (std::uint32_t i = 0; i < std::min<std::uint32_t>(velocities->jointCount, kHandJoints); ++i)
    velocities->jointVelocities[i] = {
        locations.isActive ? XR_SPACE_VELOCITY_LINEAR_VALID_BIT : XrSpaceVelocityFlags{0},
        {v.x(), v.y(), v.z()},
        {0.0f, 0.0f, 0.0f}};
}

XrResult XRAPI_CALL locate_hand(XrHandTrackerEXT handle, const XrHandJointsLocateInfoEXT* info,
                                XrHandJointLocationsEXT* locations) {
  XrCall call("xrLocateHandJointsEXT");
  if (call.early()) return *call.early();
  const HandTracker* tracker = runtime().hand_trackers.find(handle);
  if (!tracker) return call.wrong(XR_ERROR_HANDLE_INVALID, "the hand tracker is not alive");
  if (!call.session(tracker->session) || !is_fine_hand(call, info, locations)) return call.result();
  const Space* base = runtime().spaces.find(info->baseSpace);
  if (!base) return call.wrong(XR_ERROR_HANDLE_INVALID, "the space is not alive");
  const Located from = space_located(*base, info->time);
  const bool is_left = tracker->hand == Hand::kLeft;
  const Located hand =
      point_located(is_left ? TrackedPoint::kLeftHand : TrackedPoint::kRightHand, info->time);
  const HandSkeleton skeleton =
      hand_skeleton(tracker->hand, is_fist_at(runtime().script, script_time_s(info->time)));
  locations->isActive = hand.flags != 0 && from.flags != 0;
  for (std::size_t i = 0; i < kHandJoints; ++i) {
    XrHandJointLocationEXT& joint = locations->jointLocations[i];
    joint.pose = pose_in(from, moved(hand, skeleton.T_GJ[i]), joint.locationFlags);
    joint.radius = skeleton.radius_m[i];
  }
  fill_velocities(from, hand, *locations);
  return XR_SUCCESS;
}

}  // namespace

void add_hand_functions(XrFunctionMap& map) {
  constexpr const char* kExtension = XR_EXT_HAND_TRACKING_EXTENSION_NAME;
  add_function(map, "xrCreateHandTrackerEXT", create_hand, kExtension);
  add_function(map, "xrDestroyHandTrackerEXT", destroy_hand, kExtension);
  add_function(map, "xrLocateHandJointsEXT", locate_hand, kExtension);
}

}  // namespace dance::test_xr
