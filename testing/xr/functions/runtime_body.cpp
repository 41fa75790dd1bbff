// Body tracking: XR_FB_body_tracking with XR_META_body_tracking_full_body, and XR_BD_body_tracking.
#include "testing/xr/functions/runtime_functions.h"
#include "testing/xr/script/body_skeleton.h"
#include "testing/xr/state/runtime_call.h"
#include "testing/xr/state/runtime_poses.h"

namespace dance::test_xr {
namespace {

template <class Handle>
XrResult make_tracker(XrCall& call, XrSession session, std::uint32_t joints,
                      HandleTable<Handle, BodyTracker>& table, Handle* tracker) {
  if (!runtime().script.has_body)
    return call.wrong(XR_ERROR_FEATURE_UNSUPPORTED, "the system does not track bodies");
  auto made = std::make_unique<BodyTracker>();
  made->session = session;
  made->joints = joints;
  *tracker = table.add(std::move(made));
  return XR_SUCCESS;
}

XrResult XRAPI_CALL create_fb(XrSession session, const XrBodyTrackerCreateInfoFB* info,
                              XrBodyTrackerFB* tracker) {
  XrCall call("xrCreateBodyTrackerFB");
  if (call.early()) return *call.early();
  Runtime& rt = runtime();
  if (!call.session(session) || !call.is_fine(info, XR_TYPE_BODY_TRACKER_CREATE_INFO_FB))
    return call.result();
  const bool is_full = info->bodyJointSet == XR_BODY_JOINT_SET_FULL_BODY_META;
  if (is_full && !rt.extensions.count(XR_META_BODY_TRACKING_FULL_BODY_EXTENSION_NAME))
    return call.wrong(XR_ERROR_VALIDATION_FAILURE, "the full body's extension was not enabled");
  if (!is_full && info->bodyJointSet != XR_BODY_JOINT_SET_DEFAULT_FB)
    return call.wrong(XR_ERROR_VALIDATION_FAILURE, "an unknown set of joints");
  return make_tracker(call, session, is_full ? 84 : 70, rt.fb_trackers, tracker);
}

XrResult XRAPI_CALL create_bd(XrSession session, const XrBodyTrackerCreateInfoBD* info,
                              XrBodyTrackerBD* tracker) {
  XrCall call("xrCreateBodyTrackerBD");
  if (call.early()) return *call.early();
  if (!call.session(session) || !call.is_fine(info, XR_TYPE_BODY_TRACKER_CREATE_INFO_BD))
    return call.result();
  const bool is_full = info->jointSet == XR_BODY_JOINT_SET_FULL_BODY_JOINTS_BD;
  if (!is_full && info->jointSet != XR_BODY_JOINT_SET_BODY_WITHOUT_ARM_BD)
    return call.wrong(XR_ERROR_VALIDATION_FAILURE, "an unknown set of joints");
  return make_tracker(call, session, is_full ? 24 : 16, runtime().bd_trackers, tracker);
}

XrResult XRAPI_CALL destroy_fb(XrBodyTrackerFB tracker) {
  XrCall call("xrDestroyBodyTrackerFB");
  if (!runtime().fb_trackers.remove(tracker))
    return call.wrong(XR_ERROR_HANDLE_INVALID, "the body tracker is not alive");
  return XR_SUCCESS;
}

XrResult XRAPI_CALL destroy_bd(XrBodyTrackerBD tracker) {
  XrCall call("xrDestroyBodyTrackerBD");
  if (!runtime().bd_trackers.remove(tracker))
    return call.wrong(XR_ERROR_HANDLE_INVALID, "the body tracker is not alive");
  return XR_SUCCESS;
}

// The body is as well tracked as the head.
template <class Location>
bool fill_joints(const Space& base, XrTime time, const std::vector<Pose>& joints,
                 std::uint32_t count, Location* locations) {
  const Located from = space_located(base, time);
  const Located head = point_located(TrackedPoint::kHead, time);
  bool is_tracked = true;
  for (std::uint32_t i = 0; i < count; ++i) {
    Located joint;
    joint.state.p_m = joints[i].translation();
    joint.state.R = Eigen::Quaterniond(joints[i].linear());
    joint.flags = head.flags;
    locations[i].pose = pose_in(from, joint, locations[i].locationFlags);
    is_tracked =
        is_tracked && (locations[i].locationFlags & XR_SPACE_LOCATION_POSITION_TRACKED_BIT);
  }
  return is_tracked;
}

XrResult XRAPI_CALL locate_fb(XrBodyTrackerFB handle, const XrBodyJointsLocateInfoFB* info,
                              XrBodyJointLocationsFB* locations) {
  XrCall call("xrLocateBodyJointsFB");
  if (call.early()) return *call.early();
  const BodyTracker* tracker = runtime().fb_trackers.find(handle);
  if (!tracker) return call.wrong(XR_ERROR_HANDLE_INVALID, "the body tracker is not alive");
  if (!call.session(tracker->session) || !call.is_fine(info, XR_TYPE_BODY_JOINTS_LOCATE_INFO_FB) ||
      !call.is_fine(locations, XR_TYPE_BODY_JOINT_LOCATIONS_FB) || !call.is_fine_time(info->time))
    return call.result();
  const Space* base = runtime().spaces.find(info->baseSpace);
  if (!base) return call.wrong(XR_ERROR_HANDLE_INVALID, "the space is not alive");
  if (locations->jointCount != tracker->joints || !locations->jointLocations)
    return call.wrong(XR_ERROR_VALIDATION_FAILURE, text_of("not %u joints", tracker->joints));
  const auto joints = full_body(runtime().script, script_time_s(info->time));
  const bool is_tracked =
      fill_joints(*base, info->time, joints, tracker->joints, locations->jointLocations);
  locations->isActive = point_located(TrackedPoint::kHead, info->time).flags != 0;
  locations->confidence = is_tracked ? 1.0f : 0.0f;
  locations->skeletonChangedCount = 1;
  locations->time = info->time;
  return XR_SUCCESS;
}

XrResult XRAPI_CALL skeleton_fb(XrBodyTrackerFB handle, XrBodySkeletonFB* skeleton) {
  XrCall call("xrGetBodySkeletonFB");
  if (call.early()) return *call.early();
  const BodyTracker* tracker = runtime().fb_trackers.find(handle);
  if (!tracker) return call.wrong(XR_ERROR_HANDLE_INVALID, "the body tracker is not alive");
  if (!call.session(tracker->session) || !call.is_fine(skeleton, XR_TYPE_BODY_SKELETON_FB))
    return call.result();
  if (skeleton->jointCount != tracker->joints || !skeleton->joints)
    return call.wrong(XR_ERROR_VALIDATION_FAILURE, text_of("not %u joints", tracker->joints));
  const auto joints = full_body(default_script(), 0.0);
  for (std::uint32_t i = 0; i < tracker->joints; ++i)
    skeleton->joints[i] = {static_cast<std::int32_t>(i), i == 0 ? XR_BODY_JOINT_NONE_FB : 0,
                           xr_pose(joints[i])};
  return XR_SUCCESS;
}

XrResult XRAPI_CALL locate_bd(XrBodyTrackerBD handle, const XrBodyJointsLocateInfoBD* info,
                              XrBodyJointLocationsBD* locations) {
  XrCall call("xrLocateBodyJointsBD");
  if (call.early()) return *call.early();
  const BodyTracker* tracker = runtime().bd_trackers.find(handle);
  if (!tracker) return call.wrong(XR_ERROR_HANDLE_INVALID, "the body tracker is not alive");
  if (!call.session(tracker->session) || !call.is_fine(info, XR_TYPE_BODY_JOINTS_LOCATE_INFO_BD) ||
      !call.is_fine(locations, XR_TYPE_BODY_JOINT_LOCATIONS_BD) || !call.is_fine_time(info->time))
    return call.result();
  const Space* base = runtime().spaces.find(info->baseSpace);
  if (!base) return call.wrong(XR_ERROR_HANDLE_INVALID, "the space is not alive");
  if (locations->jointLocationCount != tracker->joints || !locations->jointLocations)
    return call.wrong(XR_ERROR_VALIDATION_FAILURE, text_of("not %u joints", tracker->joints));
  const auto joints = small_body(runtime().script, script_time_s(info->time));
  locations->allJointPosesTracked =
      fill_joints(*base, info->time, joints, tracker->joints, locations->jointLocations);
  return XR_SUCCESS;
}

}  // namespace

void add_body_functions(XrFunctionMap& map) {
  constexpr const char* kMeta = XR_FB_BODY_TRACKING_EXTENSION_NAME;
  add_function(map, "xrCreateBodyTrackerFB", create_fb, kMeta);
  add_function(map, "xrDestroyBodyTrackerFB", destroy_fb, kMeta);
  add_function(map, "xrLocateBodyJointsFB", locate_fb, kMeta);
  add_function(map, "xrGetBodySkeletonFB", skeleton_fb, kMeta);
  constexpr const char* kPico = XR_BD_BODY_TRACKING_EXTENSION_NAME;
  add_function(map, "xrCreateBodyTrackerBD", create_bd, kPico);
  add_function(map, "xrDestroyBodyTrackerBD", destroy_bd, kPico);
  add_function(map, "xrLocateBodyJointsBD", locate_bd, kPico);
}

}  // namespace dance::test_xr
