// Spaces and views: where things are.
#include <numbers>

#include "testing/xr/functions/runtime_functions.h"
#include "testing/xr/state/runtime_call.h"
#include "testing/xr/state/runtime_paths.h"
#include "testing/xr/state/runtime_poses.h"

namespace dance::test_xr {
namespace {

std::vector<XrReferenceSpaceType> reference_types() {
  std::vector<XrReferenceSpaceType> types{XR_REFERENCE_SPACE_TYPE_VIEW,
                                          XR_REFERENCE_SPACE_TYPE_LOCAL};
  if (runtime().script.has_stage) types.push_back(XR_REFERENCE_SPACE_TYPE_STAGE);
  return types;
}

XrResult XRAPI_CALL enumerate_spaces(XrSession session, uint32_t capacity, uint32_t* count,
                                     XrReferenceSpaceType* types) {
  XrCall call("xrEnumerateReferenceSpaces");
  if (call.early()) return *call.early();
  if (!call.session(session)) return call.result();
  return give_list(call, reference_types(), capacity, count, types);
}

XrResult XRAPI_CALL create_reference(XrSession session, const XrReferenceSpaceCreateInfo* info,
                                     XrSpace* space) {
  XrCall call("xrCreateReferenceSpace");
  if (call.early()) return *call.early();
  if (!call.session(session) || !call.is_fine(info, XR_TYPE_REFERENCE_SPACE_CREATE_INFO) ||
      !call.is_fine_pose(info->poseInReferenceSpace, "poseInReferenceSpace"))
    return call.result();
  auto made = std::make_unique<Space>();
  made->session = session;
  made->offset = pose_of(info->poseInReferenceSpace);
  if (info->referenceSpaceType == XR_REFERENCE_SPACE_TYPE_VIEW)
    made->kind = SpaceKind::kView;
  else if (info->referenceSpaceType == XR_REFERENCE_SPACE_TYPE_LOCAL)
    made->kind = SpaceKind::kLocal;
  else if (info->referenceSpaceType == XR_REFERENCE_SPACE_TYPE_STAGE && runtime().script.has_stage)
    made->kind = SpaceKind::kStage;
  else
    return call.wrong(XR_ERROR_REFERENCE_SPACE_UNSUPPORTED, "a space that is not enumerated");
  *space = runtime().spaces.add(std::move(made));
  return XR_SUCCESS;
}

XrResult XRAPI_CALL bounds(XrSession session, XrReferenceSpaceType type, XrExtent2Df* extent) {
  XrCall call("xrGetReferenceSpaceBoundsRect");
  if (call.early()) return *call.early();
  if (!call.session(session)) return call.result();
  *extent = {0.0f, 0.0f};
  if (type != XR_REFERENCE_SPACE_TYPE_STAGE || !runtime().script.has_stage)
    return XR_SPACE_BOUNDS_UNAVAILABLE;
  *extent = {3.0f, 2.5f};
  return XR_SUCCESS;
}

XrResult XRAPI_CALL create_action_space(XrSession session, const XrActionSpaceCreateInfo* info,
                                        XrSpace* space) {
  XrCall call("xrCreateActionSpace");
  if (call.early()) return *call.early();
  if (!call.session(session) || !call.is_fine(info, XR_TYPE_ACTION_SPACE_CREATE_INFO) ||
      !call.is_fine_pose(info->poseInActionSpace, "poseInActionSpace"))
    return call.result();
  const Action* action = runtime().actions.find(info->action);
  if (!action) return call.wrong(XR_ERROR_HANDLE_INVALID, "the action is not alive");
  if (action->type != XR_ACTION_TYPE_POSE_INPUT)
    return call.wrong(XR_ERROR_ACTION_TYPE_MISMATCH, action->name + " is no pose");
  const auto& paths = action->subactions;
  if (info->subactionPath != XR_NULL_PATH &&
      std::find(paths.begin(), paths.end(), info->subactionPath) == paths.end())
    return call.wrong(XR_ERROR_PATH_UNSUPPORTED, action->name + " has no such subaction path");
  auto made = std::make_unique<Space>();
  made->session = session;
  made->kind = SpaceKind::kAction;
  made->action = info->action;
  made->subaction = info->subactionPath;
  made->offset = pose_of(info->poseInActionSpace);
  *space = runtime().spaces.add(std::move(made));
  return XR_SUCCESS;
}

XrResult XRAPI_CALL destroy_space(XrSpace space) {
  XrCall call("xrDestroySpace");
  if (!runtime().spaces.remove(space))
    return call.wrong(XR_ERROR_HANDLE_INVALID, "the space is not alive");
  return XR_SUCCESS;
}

void fill_velocity(const Located& base, const Located& thing, XrSpaceVelocity& velocity) {
  velocity.velocityFlags = 0;
  if (thing.flags == 0 || base.flags == 0) return;
  velocity.velocityFlags = XR_SPACE_VELOCITY_LINEAR_VALID_BIT | XR_SPACE_VELOCITY_ANGULAR_VALID_BIT;
  const Eigen::Matrix3d into = base.state.R.toRotationMatrix().transpose();
  const Eigen::Vector3d arm = thing.state.p_m - base.state.p_m;
  const Eigen::Vector3d v =
      into * (thing.state.v_mps - base.state.v_mps - base.state.w_radps.cross(arm));
  const Eigen::Vector3d w = into * (thing.state.w_radps - base.state.w_radps);
  const auto put = [](const Eigen::Vector3d& from) {
    const Eigen::Vector3f f = from.cast<float>();
    return XrVector3f{f.x(), f.y(), f.z()};
  };
  velocity.linearVelocity = put(v);
  velocity.angularVelocity = put(w);
}

XrResult XRAPI_CALL locate_space(XrSpace space, XrSpace base, XrTime time,
                                 XrSpaceLocation* location) {
  XrCall call("xrLocateSpace");
  if (call.early()) return *call.early();
  const Space* thing_space = runtime().spaces.find(space);
  const Space* base_space = runtime().spaces.find(base);
  if (!thing_space || !base_space)
    return call.wrong(XR_ERROR_HANDLE_INVALID, "a space is not alive");
  if (!call.session(thing_space->session) ||
      !call.is_fine(location, XR_TYPE_SPACE_LOCATION, {XR_TYPE_SPACE_VELOCITY}) ||
      !call.is_fine_time(time))
    return call.result();
  const Located thing = space_located(*thing_space, time);
  const Located from = space_located(*base_space, time);
  location->pose = pose_in(from, thing, location->locationFlags);
  if (auto* velocity = find_next<XrSpaceVelocity>(location->next, XR_TYPE_SPACE_VELOCITY))
    fill_velocity(from, thing, *velocity);
  return XR_SUCCESS;
}

constexpr double kEyesApart_m = 0.064;

XrFovf fov_of_eye(std::uint32_t eye) {
  std::array<float, 4> rad{};
  for (std::size_t i = 0; i < rad.size(); ++i)
    rad[i] = static_cast<float>(runtime().script.fov_deg[i] * std::numbers::pi / 180.0);
  return eye == 0 ? XrFovf{rad[0], rad[1], rad[2], rad[3]}
                  : XrFovf{-rad[1], -rad[0], rad[2], rad[3]};
}

XrResult XRAPI_CALL locate_views(XrSession handle, const XrViewLocateInfo* info, XrViewState* state,
                                 uint32_t capacity, uint32_t* count, XrView* views) {
  XrCall call("xrLocateViews");
  if (call.early()) return *call.early();
  const Session* session = call.session(handle);
  if (!session || !call.is_fine(info, XR_TYPE_VIEW_LOCATE_INFO) ||
      !call.is_fine(state, XR_TYPE_VIEW_STATE) || !call.is_fine_time(info->displayTime))
    return call.result();
  if (info->viewConfigurationType != XR_VIEW_CONFIGURATION_TYPE_PRIMARY_STEREO)
    return call.wrong(XR_ERROR_VIEW_CONFIGURATION_TYPE_UNSUPPORTED, "only stereo is there");
  const Space* base = runtime().spaces.find(info->space);
  if (!base) return call.wrong(XR_ERROR_HANDLE_INVALID, "the space is not alive");
  for (std::uint32_t i = 0; views && i < std::min(capacity, 2u); ++i)
    if (!call.is_fine(&views[i], XR_TYPE_VIEW)) return call.result();
  const Located from = space_located(*base, info->displayTime);
  const Located head = point_located(TrackedPoint::kHead, info->displayTime);
  std::vector<XrView> found;
  for (std::uint32_t eye = 0; eye < 2; ++eye) {
    const double x_m = (eye == 0 ? -0.5 : 0.5) * kEyesApart_m;
    const Located located = moved(head, pose_of({x_m, 0.0, 0.0}, Eigen::Quaterniond::Identity()));
    XrSpaceLocationFlags flags = 0;
    const XrPosef pose = pose_in(from, located, flags);
    state->viewStateFlags = flags;  // the same bits
    found.push_back({XR_TYPE_VIEW, nullptr, pose, fov_of_eye(eye)});
  }
  return give_list(call, found, capacity, count, views);
}

}  // namespace

void add_space_functions(XrFunctionMap& map) {
  add_function(map, "xrEnumerateReferenceSpaces", enumerate_spaces);
  add_function(map, "xrCreateReferenceSpace", create_reference);
  add_function(map, "xrGetReferenceSpaceBoundsRect", bounds);
  add_function(map, "xrCreateActionSpace", create_action_space);
  add_function(map, "xrDestroySpace", destroy_space);
  add_function(map, "xrLocateSpace", locate_space);
}

void add_view_functions(XrFunctionMap& map) { add_function(map, "xrLocateViews", locate_views); }

}  // namespace dance::test_xr
