// xrWaitFrame, xrBeginFrame, xrEndFrame.
#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <thread>

#include "testing/xr/functions/runtime_functions.h"
#include "testing/xr/functions/runtime_layers.h"
#include "testing/xr/state/runtime_call.h"
#include "testing/xr/state/runtime_events.h"

namespace dance::test_xr {
namespace {

std::int64_t period_ns() { return static_cast<std::int64_t>(1e9 / runtime().script.refresh_hz); }

// The time that the application gets: each bad time of the script in one frame.
XrTime reported_time(XrTime display_ns, Session& session) {
  std::deque<std::string>& bad_times = runtime().bad_times;
  session.is_time_bad = !bad_times.empty();
  if (bad_times.empty()) return display_ns;
  const std::string bad = bad_times.front();
  bad_times.pop_front();
  XrTime reported = display_ns;
  if (bad == "zero") reported = 0;
  if (bad == "past") reported = display_ns - 1'000'000'000;
  if (bad == "far") reported = display_ns + 10'000'000'000;
  if (bad == "garbage") reported = 0x5A5A5A5A5A5A5A5A;
  return reported;
}

// The tick of the display to sleep until: the next one, and never one twice.
XrTime next_tick(Session& session) {
  const std::int64_t period = period_ns();
  session.last_tick = std::max(session.last_tick + 1, now_ns() / period + 1);
  return session.last_tick * period;
}

void note_predicted(Session& session, XrTime reported_ns) {
  session.waited_ns = reported_ns;
  session.predicted_ns.push_back(reported_ns);
  if (session.predicted_ns.size() > 16) session.predicted_ns.pop_front();
}

XrResult XRAPI_CALL wait_frame(XrSession handle, const XrFrameWaitInfo* info, XrFrameState* state) {
  XrCall call("xrWaitFrame");
  if (call.early()) return *call.early();
  Session* session = call.session(handle);
  if (!session || (info && !call.is_fine(info, XR_TYPE_FRAME_WAIT_INFO)) ||
      !call.is_fine(state, XR_TYPE_FRAME_STATE))
    return call.result();
  if (!session->is_running)
    return call.wrong(XR_ERROR_SESSION_NOT_RUNNING, "the session does not run");
  // A second wait waits for the frame before it to begin.
  const auto is_free = [&] {
    const Session* now = runtime().sessions.find(handle);
    return !now || !now->is_running || !now->waited_ns;
  };
  if (!runtime().frame_begun.wait_for(call.lock(), std::chrono::seconds(1), is_free))
    call.misuse("xrBeginFrame did not follow the last one for a second");
  session = runtime().sessions.find(handle);
  if (!session || !session->is_running)
    return call.wrong(XR_ERROR_SESSION_NOT_RUNNING, "the session ended meanwhile");
  const XrTime tick_ns = next_tick(*session);
  call.lock().unlock();
  std::this_thread::sleep_for(std::chrono::nanoseconds(std::max<XrTime>(0, tick_ns - now_ns())));
  call.lock().lock();
  session = runtime().sessions.find(handle);
  if (!session || !session->is_running)
    return call.wrong(XR_ERROR_SESSION_NOT_RUNNING, "the session ended meanwhile");
  advance_script();
  // Drawn until the next tick, then shown for a period: its middle.
  state->predictedDisplayTime = reported_time(tick_ns + period_ns() * 3 / 2, *session);
  state->predictedDisplayPeriod = period_ns();
  state->shouldRender = !session->is_headless && (session->state == XR_SESSION_STATE_VISIBLE ||
                                                  session->state == XR_SESSION_STATE_FOCUSED);
  note_predicted(*session, state->predictedDisplayTime);
  return session->lost_at_s ? XR_SESSION_LOSS_PENDING : XR_SUCCESS;
}

XrResult XRAPI_CALL begin_frame(XrSession handle, const XrFrameBeginInfo* info) {
  XrCall call("xrBeginFrame");
  if (call.early()) return *call.early();
  Session* session = call.session(handle);
  if (!session || (info && !call.is_fine(info, XR_TYPE_FRAME_BEGIN_INFO))) return call.result();
  if (!session->is_running)
    return call.wrong(XR_ERROR_SESSION_NOT_RUNNING, "the session does not run");
  if (!session->waited_ns)
    return call.wrong(XR_ERROR_CALL_ORDER_INVALID, "xrWaitFrame did not precede");
  const bool is_discarding = session->begun_ns.has_value();
  if (is_discarding) call.misuse("the frame before was not ended");
  session->begun_ns = session->waited_ns;
  session->waited_ns.reset();
  session->has_begun_frames = true;
  runtime().frame_begun.notify_all();
  advance_script();
  return is_discarding ? XR_FRAME_DISCARDED : XR_SUCCESS;
}

XrResult check_display_time(XrCall& call, const Session& session, XrTime time_ns) {
  const auto& known = session.predicted_ns;
  const bool is_known = std::find(known.begin(), known.end(), time_ns) != known.end();
  // After a time that was wrong the application may have found a better one.
  const bool is_plausible = session.is_time_bad && std::llabs(time_ns - now_ns()) < 1'000'000'000;
  if (!call.is_fine_time(time_ns)) return call.result();
  if (!is_known && !is_plausible) call.misuse("a display time that was never predicted");
  return XR_SUCCESS;
}

XrResult XRAPI_CALL end_frame(XrSession handle, const XrFrameEndInfo* info) {
  XrCall call("xrEndFrame");
  if (call.early()) return *call.early();
  Session* session = call.session(handle);
  if (!session || !call.is_fine(info, XR_TYPE_FRAME_END_INFO)) return call.result();
  if (!session->is_running)
    return call.wrong(XR_ERROR_SESSION_NOT_RUNNING, "the session does not run");
  if (!session->begun_ns)
    return call.wrong(XR_ERROR_CALL_ORDER_INVALID, "xrBeginFrame did not precede");
  XrResult result = check_display_time(call, *session, info->displayTime);
  if (result == XR_SUCCESS) result = check_layers(call, *session, *info);
  session->begun_ns.reset();
  if (result != XR_SUCCESS) return result;
  record_frame(call, *session, *info);
  ++session->frames;
  session->has_ended_a_frame = true;
  advance_script();
  return session->lost_at_s ? XR_SESSION_LOSS_PENDING : XR_SUCCESS;
}

}  // namespace

void add_frame_functions(XrFunctionMap& map) {
  add_function(map, "xrWaitFrame", wait_frame);
  add_function(map, "xrBeginFrame", begin_frame);
  add_function(map, "xrEndFrame", end_frame);
}

}  // namespace dance::test_xr
