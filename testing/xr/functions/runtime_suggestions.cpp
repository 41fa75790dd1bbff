// Suggested bindings, attached action sets, and what came of both.
#include <algorithm>

#include "testing/xr/functions/runtime_functions.h"
#include "testing/xr/script/interaction_profiles.h"
#include "testing/xr/state/runtime_bindings.h"
#include "testing/xr/state/runtime_call.h"
#include "testing/xr/state/runtime_events.h"
#include "testing/xr/state/runtime_paths.h"

namespace dance::test_xr {
namespace {

// Poses are bound to poses, vibrations to haptics, all else to inputs.
bool is_of_type(const std::string& path, XrActionType type) {
  const bool is_pose =
      path.find("/input/grip") != std::string::npos || path.find("/input/aim") != std::string::npos;
  const bool is_haptic = path.ends_with("/output/haptic");
  if (type == XR_ACTION_TYPE_POSE_INPUT) return is_pose;
  if (type == XR_ACTION_TYPE_VIBRATION_OUTPUT) return is_haptic;
  return !is_pose && !is_haptic;
}

XrResult check_binding(XrCall& call, const std::string& profile,
                       const XrActionSuggestedBinding& binding) {
  const Action* action = runtime().actions.find(binding.action);
  if (!action) return call.wrong(XR_ERROR_HANDLE_INVALID, "an action is not alive");
  const std::string path = text_of_path(binding.binding);
  if (path.empty()) return call.wrong(XR_ERROR_PATH_INVALID, "a path of a binding");
  const std::string top = top_level(path);
  if (top.empty() || !has_profile_path(profile, top, path))
    return call.wrong(XR_ERROR_PATH_UNSUPPORTED, profile + " has no " + path);
  const ActionSet* set = runtime().action_sets.find(action->set);
  if (set && set->is_attached)
    return call.wrong(XR_ERROR_ACTIONSETS_ALREADY_ATTACHED, "the action set is attached already");
  if (!is_of_type(path, action->type))
    return call.wrong(XR_ERROR_PATH_UNSUPPORTED, action->name + " is not of the type of " + path);
  return XR_SUCCESS;
}

XrResult XRAPI_CALL suggest(XrInstance instance,
                            const XrInteractionProfileSuggestedBinding* suggested) {
  XrCall call("xrSuggestInteractionProfileBindings");
  if (call.early()) return *call.early();
  if (!call.has_instance(instance) ||
      !call.is_fine(suggested, XR_TYPE_INTERACTION_PROFILE_SUGGESTED_BINDING))
    return call.result();
  Runtime& rt = runtime();
  const std::string profile = text_of_path(suggested->interactionProfile);
  const bool is_tracker = profile.ends_with("/vive_tracker_htcx");
  if (!is_known_profile(profile) ||
      (is_tracker && !rt.extensions.count(XR_HTCX_VIVE_TRACKER_INTERACTION_EXTENSION_NAME)))
    return call.wrong(XR_ERROR_PATH_UNSUPPORTED, "no profile '" + profile + "'");
  if (suggested->countSuggestedBindings == 0 || !suggested->suggestedBindings)
    return call.wrong(XR_ERROR_VALIDATION_FAILURE, "no bindings");
  std::vector<Binding> bindings;
  for (std::uint32_t i = 0; i < suggested->countSuggestedBindings; ++i) {
    const XrActionSuggestedBinding& binding = suggested->suggestedBindings[i];
    if (const XrResult result = check_binding(call, profile, binding); result != XR_SUCCESS)
      return result;
    bindings.push_back({binding.action, text_of_path(binding.binding)});
  }
  rt.bindings[profile] = std::move(bindings);
  return XR_SUCCESS;
}

XrResult XRAPI_CALL attach(XrSession handle, const XrSessionActionSetsAttachInfo* info) {
  XrCall call("xrAttachSessionActionSets");
  if (call.early()) return *call.early();
  Session* session = call.session(handle);
  if (!session || !call.is_fine(info, XR_TYPE_SESSION_ACTION_SETS_ATTACH_INFO))
    return call.result();
  if (session->has_actions)
    return call.wrong(XR_ERROR_ACTIONSETS_ALREADY_ATTACHED, "a second time");
  if (info->countActionSets == 0 || !info->actionSets)
    return call.wrong(XR_ERROR_VALIDATION_FAILURE, "no action sets");
  for (std::uint32_t i = 0; i < info->countActionSets; ++i)
    if (!runtime().action_sets.find(info->actionSets[i]))
      return call.wrong(XR_ERROR_HANDLE_INVALID, "an action set is not alive");
  for (std::uint32_t i = 0; i < info->countActionSets; ++i)
    runtime().action_sets.find(info->actionSets[i])->is_attached = true;
  session->has_actions = true;
  choose_profiles(*session);
  return XR_SUCCESS;
}

XrResult XRAPI_CALL current_profile(XrSession handle, XrPath top,
                                    XrInteractionProfileState* state) {
  XrCall call("xrGetCurrentInteractionProfile");
  if (call.early()) return *call.early();
  const Session* session = call.session(handle);
  if (!session || !call.is_fine(state, XR_TYPE_INTERACTION_PROFILE_STATE)) return call.result();
  if (!session->has_actions)
    return call.wrong(XR_ERROR_ACTIONSET_NOT_ATTACHED, "no action sets are attached");
  const std::string path = text_of_path(top);
  if (path.empty()) return call.wrong(XR_ERROR_PATH_INVALID, "a top-level path");
  if (top_level(path) != path)
    return call.wrong(XR_ERROR_PATH_UNSUPPORTED, path + " is no top-level path");
  const auto found = session->profiles.find(path);
  const bool is_known = session->has_synced && found != session->profiles.end();
  state->interactionProfile = is_known ? path_of(found->second) : XR_NULL_PATH;
  return XR_SUCCESS;
}

XrResult XRAPI_CALL bound_sources(XrSession handle,
                                  const XrBoundSourcesForActionEnumerateInfo* info,
                                  uint32_t capacity, uint32_t* count, XrPath* sources) {
  XrCall call("xrEnumerateBoundSourcesForAction");
  if (call.early()) return *call.early();
  const Session* session = call.session(handle);
  if (!session || !call.is_fine(info, XR_TYPE_BOUND_SOURCES_FOR_ACTION_ENUMERATE_INFO))
    return call.result();
  if (!runtime().actions.find(info->action))
    return call.wrong(XR_ERROR_HANDLE_INVALID, "the action is not alive");
  if (!session->has_actions)
    return call.wrong(XR_ERROR_ACTIONSET_NOT_ATTACHED, "no action sets are attached");
  std::vector<XrPath> paths;
  for (const std::string& path : sources_of(*session, info->action, XR_NULL_PATH))
    paths.push_back(path_of(path));
  return give_list(call, paths, capacity, count, sources);
}

XrResult XRAPI_CALL localized_source_name(XrSession handle,
                                          const XrInputSourceLocalizedNameGetInfo* info,
                                          uint32_t capacity, uint32_t* count, char* name) {
  XrCall call("xrGetInputSourceLocalizedName");
  if (call.early()) return *call.early();
  if (!call.session(handle) || !call.is_fine(info, XR_TYPE_INPUT_SOURCE_LOCALIZED_NAME_GET_INFO))
    return call.result();
  const std::string path = text_of_path(info->sourcePath);
  if (path.empty()) return call.wrong(XR_ERROR_PATH_INVALID, "a source path");
  return give_text(call, path, capacity, count, name);
}

XrResult XRAPI_CALL tracker_paths(XrInstance instance, uint32_t capacity, uint32_t* count,
                                  XrViveTrackerPathsHTCX* paths) {
  XrCall call("xrEnumerateViveTrackerPathsHTCX");
  if (call.early()) return *call.early();
  if (!call.has_instance(instance) ||
      !call.has_extension(XR_HTCX_VIVE_TRACKER_INTERACTION_EXTENSION_NAME))
    return call.result();
  std::vector<XrViveTrackerPathsHTCX> found;
  for (const TrackedPoint point : connected_trackers()) found.push_back(tracker_paths_of(point));
  for (std::uint32_t i = 0; paths && i < std::min<std::size_t>(capacity, found.size()); ++i)
    if (!call.is_fine(&paths[i], XR_TYPE_VIVE_TRACKER_PATHS_HTCX)) return call.result();
  return give_list(call, found, capacity, count, paths);
}

}  // namespace

void add_binding_functions(XrFunctionMap& map) {
  add_function(map, "xrSuggestInteractionProfileBindings", suggest);
  add_function(map, "xrAttachSessionActionSets", attach);
  add_function(map, "xrGetCurrentInteractionProfile", current_profile);
  add_function(map, "xrEnumerateBoundSourcesForAction", bound_sources);
  add_function(map, "xrGetInputSourceLocalizedName", localized_source_name);
  add_function(map, "xrEnumerateViveTrackerPathsHTCX", tracker_paths,
               XR_HTCX_VIVE_TRACKER_INTERACTION_EXTENSION_NAME);
}

}  // namespace dance::test_xr
