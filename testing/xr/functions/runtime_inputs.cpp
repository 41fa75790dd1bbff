// xrSyncActions, the states of actions, and haptics.
#include <algorithm>
#include <cmath>

#include "testing/xr/functions/runtime_functions.h"
#include "testing/xr/state/runtime_bindings.h"
#include "testing/xr/state/runtime_call.h"
#include "testing/xr/state/runtime_events.h"
#include "testing/xr/state/runtime_paths.h"

namespace dance::test_xr {
namespace {

XrResult check_sync(XrCall& call, const XrActionsSyncInfo& info) {
  for (std::uint32_t i = 0; i < info.countActiveActionSets; ++i) {
    const XrActiveActionSet& active = info.activeActionSets[i];
    const ActionSet* set = runtime().action_sets.find(active.actionSet);
    if (!set) return call.wrong(XR_ERROR_HANDLE_INVALID, "an action set is not alive");
    if (!set->is_attached)
      return call.wrong(XR_ERROR_ACTIONSET_NOT_ATTACHED, set->name + " is not attached");
    if (active.subactionPath != XR_NULL_PATH && text_of_path(active.subactionPath).empty())
      return call.wrong(XR_ERROR_PATH_INVALID, "a subaction path");
  }
  return XR_SUCCESS;
}

void read_inputs(Session& session, const XrActionsSyncInfo& info) {
  std::map<std::pair<XrAction, XrPath>, InputValue> inputs;
  for (const auto& entry : runtime().actions) {
    const auto handle = std::bit_cast<XrAction>(entry.first);
    const Action* action = entry.second.get();
    const bool is_active = std::any_of(
        info.activeActionSets, info.activeActionSets + info.countActiveActionSets,
        [&](const XrActiveActionSet& active) { return active.actionSet == action->set; });
    if (!is_active) continue;
    std::vector<XrPath> subactions = action->subactions;
    subactions.push_back(XR_NULL_PATH);
    for (const XrPath subaction : subactions)
      inputs[{handle, subaction}] = read_input(session, handle, *action, subaction);
  }
  session.inputs = std::move(inputs);
}

XrResult XRAPI_CALL sync_actions(XrSession handle, const XrActionsSyncInfo* info) {
  XrCall call("xrSyncActions");
  if (call.early()) return *call.early();
  Session* session = call.session(handle);
  if (!session || !call.is_fine(info, XR_TYPE_ACTIONS_SYNC_INFO)) return call.result();
  if (!session->has_actions)
    return call.wrong(XR_ERROR_ACTIONSET_NOT_ATTACHED, "no action sets are attached");
  if (info->countActiveActionSets > 0 && !info->activeActionSets)
    return call.wrong(XR_ERROR_VALIDATION_FAILURE, "no action sets");
  if (const XrResult result = check_sync(call, *info); result != XR_SUCCESS) return result;
  if (session->state != XR_SESSION_STATE_FOCUSED) {
    session->inputs.clear();
    return XR_SESSION_NOT_FOCUSED;
  }
  if (!session->has_synced && !session->profiles.empty()) queue_profile_changed(handle);
  session->has_synced = true;
  read_inputs(*session, *info);
  return XR_SUCCESS;
}

// Null where the call was wrong; what was never synced is not active.
const InputValue* input_value(XrCall& call, XrSession handle, const XrActionStateGetInfo* info,
                              XrActionType type) {
  static const InputValue kInactive;
  const Session* session = call.session(handle);
  if (!session || !call.is_fine(info, XR_TYPE_ACTION_STATE_GET_INFO)) return nullptr;
  const Action* action = runtime().actions.find(info->action);
  XrResult result = XR_SUCCESS;
  if (!action)
    result = call.wrong(XR_ERROR_HANDLE_INVALID, "the action is not alive");
  else if (action->type != type)
    result = call.wrong(XR_ERROR_ACTION_TYPE_MISMATCH, action->name + " is of another type");
  else if (!session->has_actions || !runtime().action_sets.find(action->set)->is_attached)
    result = call.wrong(XR_ERROR_ACTIONSET_NOT_ATTACHED, action->name + " is not attached");
  else if (info->subactionPath != XR_NULL_PATH &&
           !std::count(action->subactions.begin(), action->subactions.end(), info->subactionPath))
    result = call.wrong(XR_ERROR_PATH_UNSUPPORTED, action->name + " has no such subaction path");
  if (result != XR_SUCCESS) {
    call.set_result(result);
    return nullptr;
  }
  const auto found = session->inputs.find({info->action, info->subactionPath});
  const bool is_known =
      found != session->inputs.end() && session->state == XR_SESSION_STATE_FOCUSED;
  return is_known ? &found->second : &kInactive;
}

template <class State, class Value>
void fill(State& state, const InputValue& value, Value current) {
  state.currentState = current;
  state.changedSinceLastSync = value.has_changed;
  state.lastChangeTime = value.changed_ns;
  state.isActive = value.is_active;
}

XrResult XRAPI_CALL get_boolean(XrSession session, const XrActionStateGetInfo* info,
                                XrActionStateBoolean* state) {
  XrCall call("xrGetActionStateBoolean");
  if (call.early()) return *call.early();
  if (!call.is_fine(state, XR_TYPE_ACTION_STATE_BOOLEAN)) return call.result();
  const InputValue* value = input_value(call, session, info, XR_ACTION_TYPE_BOOLEAN_INPUT);
  if (value) fill(*state, *value, static_cast<XrBool32>(value->x > 0.5f));
  return call.result();
}

XrResult XRAPI_CALL get_float(XrSession session, const XrActionStateGetInfo* info,
                              XrActionStateFloat* state) {
  XrCall call("xrGetActionStateFloat");
  if (call.early()) return *call.early();
  if (!call.is_fine(state, XR_TYPE_ACTION_STATE_FLOAT)) return call.result();
  const InputValue* value = input_value(call, session, info, XR_ACTION_TYPE_FLOAT_INPUT);
  if (value) fill(*state, *value, value->x);
  return call.result();
}

XrResult XRAPI_CALL get_vector2f(XrSession session, const XrActionStateGetInfo* info,
                                 XrActionStateVector2f* state) {
  XrCall call("xrGetActionStateVector2f");
  if (call.early()) return *call.early();
  if (!call.is_fine(state, XR_TYPE_ACTION_STATE_VECTOR2F)) return call.result();
  const InputValue* value = input_value(call, session, info, XR_ACTION_TYPE_VECTOR2F_INPUT);
  if (value) fill(*state, *value, XrVector2f{value->x, value->y});
  return call.result();
}

XrResult XRAPI_CALL get_pose(XrSession session, const XrActionStateGetInfo* info,
                             XrActionStatePose* state) {
  XrCall call("xrGetActionStatePose");
  if (call.early()) return *call.early();
  if (!call.is_fine(state, XR_TYPE_ACTION_STATE_POSE)) return call.result();
  const InputValue* value = input_value(call, session, info, XR_ACTION_TYPE_POSE_INPUT);
  if (value) state->isActive = value->is_active;
  return call.result();
}

}  // namespace

void add_input_functions(XrFunctionMap& map) {
  add_function(map, "xrSyncActions", sync_actions);
  add_function(map, "xrGetActionStateBoolean", get_boolean);
  add_function(map, "xrGetActionStateFloat", get_float);
  add_function(map, "xrGetActionStateVector2f", get_vector2f);
  add_function(map, "xrGetActionStatePose", get_pose);
}

}  // namespace dance::test_xr
