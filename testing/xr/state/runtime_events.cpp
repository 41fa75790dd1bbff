#include "testing/xr/state/runtime_events.h"

#include "testing/xr/state/runtime_call.h"
#include "testing/xr/state/runtime_paths.h"
#include "testing/xr/state/runtime_poses.h"

namespace dance::test_xr {
namespace {

const char* name_of(XrSessionState state) {
  switch (state) {
    case XR_SESSION_STATE_IDLE:
      return "IDLE";
    case XR_SESSION_STATE_READY:
      return "READY";
    case XR_SESSION_STATE_SYNCHRONIZED:
      return "SYNCHRONIZED";
    case XR_SESSION_STATE_VISIBLE:
      return "VISIBLE";
    case XR_SESSION_STATE_FOCUSED:
      return "FOCUSED";
    case XR_SESSION_STATE_STOPPING:
      return "STOPPING";
    case XR_SESSION_STATE_LOSS_PENDING:
      return "LOSS_PENDING";
    case XR_SESSION_STATE_EXITING:
      return "EXITING";
    default:
      return "UNKNOWN";
  }
}

XrSession session_handle(std::uint64_t number) { return std::bit_cast<XrSession>(number); }

void jump(const ScriptEvent& event, XrTime due_ns) {
  Runtime& rt = runtime();
  const XrTime change_ns = std::max(due_ns, now_ns());
  const Pose moved = pose_of(event.origin.p_m, event.origin.R);
  rt.origins.push_back({change_ns, rt.origins.back().pose * moved});
  for (const auto& [number, session] : rt.sessions) {
    for (const XrReferenceSpaceType type :
         {XR_REFERENCE_SPACE_TYPE_LOCAL, XR_REFERENCE_SPACE_TYPE_STAGE}) {
      if (type == XR_REFERENCE_SPACE_TYPE_STAGE && !rt.script.has_stage) continue;
      queue_event(XrEventDataReferenceSpaceChangePending{
          XR_TYPE_EVENT_DATA_REFERENCE_SPACE_CHANGE_PENDING, nullptr, session_handle(number), type,
          change_ns, XR_TRUE, xr_pose(moved)});
    }
  }
}

void lose_instance(const ScriptEvent& event) {
  Runtime& rt = runtime();
  rt.instance_lost_at_s = event.time_s;
  queue_event(XrEventDataInstanceLossPending{XR_TYPE_EVENT_DATA_INSTANCE_LOSS_PENDING, nullptr,
                                             now_ns() + static_cast<XrTime>(kLossDelay_s * 1e9)});
}

void lose_sessions(const ScriptEvent& event) {
  for (const auto& [number, session] : runtime().sessions) {
    if (session->lost_at_s) continue;
    session->lost_at_s = event.time_s;
    change_state(session_handle(number), *session, XR_SESSION_STATE_LOSS_PENDING);
  }
}

void carry_out(const ScriptEvent& event) {
  Runtime& rt = runtime();
  switch (event.kind) {
    case EventKind::kFocus:
      rt.is_focus_wanted = event.is_on;
      break;
    case EventKind::kVisible:
      rt.is_visible_wanted = event.is_on;
      break;
    case EventKind::kStop:
      rt.is_stop_wanted = true;
      break;
    case EventKind::kReady:
      rt.is_stop_wanted = false;
      break;
    case EventKind::kExit:
      rt.is_exit_wanted = true;
      break;
    case EventKind::kLoseSession:
      lose_sessions(event);
      break;
    case EventKind::kLoseInstance:
      lose_instance(event);
      break;
    case EventKind::kBadTime:
      rt.bad_times.push_back(event.word);
      break;
    case EventKind::kJump:
      jump(event, rt.clock_start_ns.value_or(now_ns()) + static_cast<XrTime>(event.time_s * 1e9));
      break;
    case EventKind::kFail:
      rt.failures[event.word] = static_cast<XrResult>(event.result);
      break;
  }
}

XrSessionState wanted_state(const Session& session) {
  const Runtime& rt = runtime();
  if (rt.is_stop_wanted || rt.is_exit_wanted || session.is_exit_requested)
    return XR_SESSION_STATE_STOPPING;
  const bool has_frames = session.is_headless || session.has_begun_frames;
  const bool has_shown = session.is_headless || session.has_ended_a_frame;
  if (!has_frames) return XR_SESSION_STATE_READY;
  if (!has_shown || !rt.is_visible_wanted) return XR_SESSION_STATE_SYNCHRONIZED;
  return rt.is_focus_wanted ? XR_SESSION_STATE_FOCUSED : XR_SESSION_STATE_VISIBLE;
}

// READY, SYNCHRONIZED, VISIBLE and FOCUSED are numbers in a row: 2 to 5; STOPPING is 6.
void step_running(XrSession handle, Session& session) {
  while (true) {
    const XrSessionState wanted = wanted_state(session);
    const int now = session.state;
    if (wanted == XR_SESSION_STATE_STOPPING) {
      if (now == XR_SESSION_STATE_STOPPING) return;
      const bool may_stop = now <= XR_SESSION_STATE_SYNCHRONIZED;
      change_state(handle, session,
                   may_stop ? XR_SESSION_STATE_STOPPING : static_cast<XrSessionState>(now - 1));
      continue;
    }
    if (now == wanted || now == XR_SESSION_STATE_STOPPING) return;
    change_state(handle, session, static_cast<XrSessionState>(now < wanted ? now + 1 : now - 1));
  }
}

void step_session(XrSession handle, Session& session) {
  const Runtime& rt = runtime();
  if (session.lost_at_s) {
    if (script_now_s() >= *session.lost_at_s + kLossDelay_s) session.is_lost = true;
    return;
  }
  if (session.is_running) return step_running(handle, session);
  const bool is_leaving = rt.is_exit_wanted || session.is_exit_requested;
  if (session.state == XR_SESSION_STATE_IDLE && is_leaving)
    change_state(handle, session, XR_SESSION_STATE_EXITING);
  else if (session.state == XR_SESSION_STATE_IDLE && !rt.is_stop_wanted)
    change_state(handle, session, XR_SESSION_STATE_READY);
}

void announce_trackers() {
  Runtime& rt = runtime();
  if (!rt.clock_start_ns || !rt.extensions.count(XR_HTCX_VIVE_TRACKER_INTERACTION_EXTENSION_NAME))
    return;
  for (const TrackedPoint point : connected_trackers()) {
    if (!rt.announced.insert(point).second) continue;
    rt.tracker_paths.push_back(tracker_paths_of(point));
    queue_event(XrEventDataViveTrackerConnectedHTCX{XR_TYPE_EVENT_DATA_VIVE_TRACKER_CONNECTED_HTCX,
                                                    nullptr, &rt.tracker_paths.back()});
  }
}

}  // namespace

void change_state(XrSession handle, Session& session, XrSessionState state) {
  session.state = state;
  runtime().record.line(text_of("session %s %.3f", name_of(state), script_now_s()));
  queue_event(XrEventDataSessionStateChanged{XR_TYPE_EVENT_DATA_SESSION_STATE_CHANGED, nullptr,
                                             handle, state, now_ns()});
}

void queue_profile_changed(XrSession handle) {
  queue_event(XrEventDataInteractionProfileChanged{XR_TYPE_EVENT_DATA_INTERACTION_PROFILE_CHANGED,
                                                   nullptr, handle});
}

void advance_script() {
  Runtime& rt = runtime();
  const double t_s = script_now_s();
  while (rt.next_event < rt.script.events.size() && rt.script.events[rt.next_event].time_s <= t_s)
    carry_out(rt.script.events[rt.next_event++]);
  for (const auto& [number, session] : rt.sessions) step_session(session_handle(number), *session);
  announce_trackers();
}

}  // namespace dance::test_xr
