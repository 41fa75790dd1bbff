// Paths, action sets and actions.
#include <algorithm>
#include <cstring>

#include "testing/xr/functions/runtime_functions.h"
#include "testing/xr/state/runtime_call.h"
#include "testing/xr/state/runtime_paths.h"

namespace dance::test_xr {
namespace {

XrResult XRAPI_CALL string_to_path(XrInstance instance, const char* text, XrPath* path) {
  XrCall call("xrStringToPath");
  if (call.early()) return *call.early();
  if (!call.has_instance(instance)) return call.result();
  if (!text || !path) return call.wrong(XR_ERROR_VALIDATION_FAILURE, "a null pointer");
  if (!is_fine_path(text))
    return call.wrong(XR_ERROR_PATH_FORMAT_INVALID, std::string("'") + text + "' is no path");
  *path = path_of(text);
  return XR_SUCCESS;
}

XrResult XRAPI_CALL path_to_string(XrInstance instance, XrPath path, uint32_t capacity,
                                   uint32_t* count, char* text) {
  XrCall call("xrPathToString");
  if (call.early()) return *call.early();
  if (!call.has_instance(instance)) return call.result();
  const std::string found = text_of_path(path);
  if (found.empty()) return call.wrong(XR_ERROR_PATH_INVALID, "a path that was never made");
  return give_text(call, found, capacity, count, text);
}

bool is_fine_name(const char* name, std::size_t size) {
  const std::string_view text(name, strnlen(name, size));
  if (text.empty() || text.size() == size) return false;
  return std::all_of(text.begin(), text.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '-' || c == '_' || c == '.';
  });
}

XrResult XRAPI_CALL create_action_set(XrInstance instance, const XrActionSetCreateInfo* info,
                                      XrActionSet* set) {
  XrCall call("xrCreateActionSet");
  if (call.early()) return *call.early();
  if (!call.has_instance(instance) || !call.is_fine(info, XR_TYPE_ACTION_SET_CREATE_INFO))
    return call.result();
  if (!is_fine_name(info->actionSetName, sizeof info->actionSetName))
    return call.wrong(XR_ERROR_NAME_INVALID, "the name of the action set");
  if (info->localizedActionSetName[0] == '\0')
    return call.wrong(XR_ERROR_LOCALIZED_NAME_INVALID, "no localised name");
  for (const auto& [number, other] : runtime().action_sets)
    if (other->name == info->actionSetName)
      return call.wrong(XR_ERROR_NAME_DUPLICATED, other->name + " is there already");
  auto made = std::make_unique<ActionSet>();
  made->name = info->actionSetName;
  *set = runtime().action_sets.add(std::move(made));
  return XR_SUCCESS;
}

XrResult XRAPI_CALL destroy_action_set(XrActionSet set) {
  XrCall call("xrDestroyActionSet");
  if (!runtime().action_sets.remove(set))
    return call.wrong(XR_ERROR_HANDLE_INVALID, "the action set is not alive");
  runtime().actions.remove_if([set](const Action& action) { return action.set == set; });
  return XR_SUCCESS;
}

XrResult check_subactions(XrCall& call, const XrActionCreateInfo& info) {
  if (info.countSubactionPaths > 0 && !info.subactionPaths)
    return call.wrong(XR_ERROR_VALIDATION_FAILURE, "no subaction paths");
  for (std::uint32_t i = 0; i < info.countSubactionPaths; ++i) {
    const std::string path = text_of_path(info.subactionPaths[i]);
    if (path.empty()) return call.wrong(XR_ERROR_PATH_INVALID, "a subaction path");
    if (top_level(path) != path)
      return call.wrong(XR_ERROR_PATH_UNSUPPORTED, path + " is no top-level path");
    if (std::count(info.subactionPaths, info.subactionPaths + i, info.subactionPaths[i]))
      return call.wrong(XR_ERROR_PATH_UNSUPPORTED, path + " stands there twice");
  }
  return XR_SUCCESS;
}

XrResult XRAPI_CALL create_action(XrActionSet set, const XrActionCreateInfo* info,
                                  XrAction* action) {
  XrCall call("xrCreateAction");
  if (call.early()) return *call.early();
  ActionSet* owner = runtime().action_sets.find(set);
  if (!owner) return call.wrong(XR_ERROR_HANDLE_INVALID, "the action set is not alive");
  if (!call.is_fine(info, XR_TYPE_ACTION_CREATE_INFO)) return call.result();
  if (owner->is_attached)
    return call.wrong(XR_ERROR_ACTIONSETS_ALREADY_ATTACHED, "the action set is attached already");
  if (!is_fine_name(info->actionName, sizeof info->actionName))
    return call.wrong(XR_ERROR_NAME_INVALID, "the name of the action");
  if (info->localizedActionName[0] == '\0')
    return call.wrong(XR_ERROR_LOCALIZED_NAME_INVALID, "no localised name");
  if (const XrResult result = check_subactions(call, *info); result != XR_SUCCESS) return result;
  if (!owner->names.insert(info->actionName).second)
    return call.wrong(XR_ERROR_NAME_DUPLICATED,
                      std::string(info->actionName) + " is there already");
  auto made = std::make_unique<Action>();
  made->set = set;
  made->type = info->actionType;
  made->name = info->actionName;
  made->subactions.assign(info->subactionPaths, info->subactionPaths + info->countSubactionPaths);
  *action = runtime().actions.add(std::move(made));
  return XR_SUCCESS;
}

XrResult XRAPI_CALL destroy_action(XrAction action) {
  XrCall call("xrDestroyAction");
  const Action* found = runtime().actions.find(action);
  if (!found) return call.wrong(XR_ERROR_HANDLE_INVALID, "the action is not alive");
  if (ActionSet* set = runtime().action_sets.find(found->set)) set->names.erase(found->name);
  runtime().actions.remove(action);
  return XR_SUCCESS;
}

}  // namespace

void add_action_functions(XrFunctionMap& map) {
  add_function(map, "xrStringToPath", string_to_path);
  add_function(map, "xrPathToString", path_to_string);
  add_function(map, "xrCreateActionSet", create_action_set);
  add_function(map, "xrDestroyActionSet", destroy_action_set);
  add_function(map, "xrCreateAction", create_action);
  add_function(map, "xrDestroyAction", destroy_action);
}

}  // namespace dance::test_xr
