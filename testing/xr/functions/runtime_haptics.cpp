// What an application lets the hands feel: recorded, not felt.
#include <algorithm>
#include <cmath>

#include "testing/xr/functions/runtime_functions.h"
#include "testing/xr/state/runtime_bindings.h"
#include "testing/xr/state/runtime_call.h"
#include "testing/xr/state/runtime_paths.h"

namespace dance::test_xr {
namespace {

XrResult check_haptic(XrCall& call, const Session& session, const XrHapticActionInfo& info) {
  const Action* action = runtime().actions.find(info.action);
  if (!action) return call.wrong(XR_ERROR_HANDLE_INVALID, "the action is not alive");
  if (action->type != XR_ACTION_TYPE_VIBRATION_OUTPUT)
    return call.wrong(XR_ERROR_ACTION_TYPE_MISMATCH, action->name + " is no vibration");
  if (!session.has_actions || !runtime().action_sets.find(action->set)->is_attached)
    return call.wrong(XR_ERROR_ACTIONSET_NOT_ATTACHED, action->name + " is not attached");
  if (info.subactionPath != XR_NULL_PATH &&
      !std::count(action->subactions.begin(), action->subactions.end(), info.subactionPath))
    return call.wrong(XR_ERROR_PATH_UNSUPPORTED, action->name + " has no such subaction path");
  return XR_SUCCESS;
}

// left, right, or the name of a tracker's point.
std::vector<std::string> places(const Session& session, const XrHapticActionInfo& info) {
  std::vector<std::string> names;
  for (const std::string& path : sources_of(session, info.action, info.subactionPath)) {
    const std::string top = top_level(path);
    const auto point = point_of_top_level(top);
    if (top.starts_with("/user/hand/"))
      names.push_back(top.substr(11));
    else if (point)
      names.emplace_back(kTrackedPointNames[index_of(*point)]);
  }
  return names;
}

XrResult XRAPI_CALL apply_haptic(XrSession handle, const XrHapticActionInfo* info,
                                 const XrHapticBaseHeader* feedback) {
  XrCall call("xrApplyHapticFeedback");
  if (call.early()) return *call.early();
  const Session* session = call.session(handle);
  if (!session || !call.is_fine(info, XR_TYPE_HAPTIC_ACTION_INFO) ||
      !call.is_fine(feedback, XR_TYPE_HAPTIC_VIBRATION))
    return call.result();
  if (const XrResult result = check_haptic(call, *session, *info); result != XR_SUCCESS)
    return result;
  const auto& vibration = *reinterpret_cast<const XrHapticVibration*>(feedback);
  if (!(vibration.amplitude >= 0.0f && vibration.amplitude <= 1.0f))
    return call.wrong(XR_ERROR_VALIDATION_FAILURE, "an amplitude outside 0 to 1");
  if (vibration.duration <= 0 && vibration.duration != XR_MIN_HAPTIC_DURATION)
    return call.wrong(XR_ERROR_VALIDATION_FAILURE, "a duration of 0 or less");
  if (!(vibration.frequency >= 0.0f) || !std::isfinite(vibration.frequency))
    return call.wrong(XR_ERROR_VALIDATION_FAILURE, "a frequency below 0");
  if (session->state != XR_SESSION_STATE_FOCUSED) return XR_SESSION_NOT_FOCUSED;
  for (const std::string& place : places(*session, *info))
    runtime().record.line(text_of("haptic %s %.4f %lld %.2f %.3f", place.c_str(),
                                  static_cast<double>(vibration.amplitude),
                                  static_cast<long long>(vibration.duration),
                                  static_cast<double>(vibration.frequency), script_now_s()));
  return XR_SUCCESS;
}

XrResult XRAPI_CALL stop_haptic(XrSession handle, const XrHapticActionInfo* info) {
  XrCall call("xrStopHapticFeedback");
  if (call.early()) return *call.early();
  const Session* session = call.session(handle);
  if (!session || !call.is_fine(info, XR_TYPE_HAPTIC_ACTION_INFO)) return call.result();
  if (const XrResult result = check_haptic(call, *session, *info); result != XR_SUCCESS)
    return result;
  if (session->state != XR_SESSION_STATE_FOCUSED) return XR_SESSION_NOT_FOCUSED;
  for (const std::string& place : places(*session, *info))
    runtime().record.line("haptic_stop " + place);
  return XR_SUCCESS;
}

}  // namespace

void add_haptic_functions(XrFunctionMap& map) {
  add_function(map, "xrApplyHapticFeedback", apply_haptic);
  add_function(map, "xrStopHapticFeedback", stop_haptic);
}

}  // namespace dance::test_xr
