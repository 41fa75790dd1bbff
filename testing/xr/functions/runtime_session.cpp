// Sessions: created, begun, ended, destroyed; and times of the system's clock.

#include "testing/xr/functions/runtime_functions.h"
#include "testing/xr/functions/runtime_gl.h"
#include "testing/xr/functions/xr_platform.h"
#include "testing/xr/state/runtime_call.h"
#include "testing/xr/state/runtime_events.h"

namespace dance::test_xr {
namespace {

XrResult XRAPI_CALL gl_requirements(XrInstance instance, XrSystemId system,
                                    XrGraphicsRequirementsOpenGLKHR* requirements) {
  XrCall call("xrGetOpenGLGraphicsRequirementsKHR");
  if (call.early()) return *call.early();
  if (!call.has_instance(instance) || !call.has_extension(XR_KHR_OPENGL_ENABLE_EXTENSION_NAME) ||
      !call.is_fine(requirements, XR_TYPE_GRAPHICS_REQUIREMENTS_OPENGL_KHR))
    return call.result();
  if (system != kSystem) return call.wrong(XR_ERROR_SYSTEM_INVALID, "not that of xrGetSystem");
  requirements->minApiVersionSupported = XR_MAKE_VERSION(3, 3, 0);
  requirements->maxApiVersionSupported = XR_MAKE_VERSION(4, 6, 0);
  runtime().has_asked_requirements = true;
  return XR_SUCCESS;
}

XrResult check_graphics(XrCall& call, const XrSessionCreateInfo& info, Session& session) {
  Runtime& rt = runtime();
  const auto* binding = find_next<XrGraphicsBindingOpenGLXlibKHR>(
      const_cast<void*>(info.next), XR_TYPE_GRAPHICS_BINDING_OPENGL_XLIB_KHR);
  session.is_headless = !binding;
  if (!binding && rt.extensions.count(XR_MND_HEADLESS_EXTENSION_NAME)) return XR_SUCCESS;
  if (!binding)
    return call.wrong(XR_ERROR_GRAPHICS_DEVICE_INVALID,
                      "no graphics binding, and XR_MND_headless was not enabled");
  if (!rt.extensions.count(XR_KHR_OPENGL_ENABLE_EXTENSION_NAME))
    return call.wrong(XR_ERROR_VALIDATION_FAILURE, "XR_KHR_opengl_enable was not enabled");
  if (!rt.has_asked_requirements)
    return call.wrong(XR_ERROR_GRAPHICS_REQUIREMENTS_CALL_MISSING,
                      "xrGetOpenGLGraphicsRequirementsKHR was not called before");
  if (!binding->xDisplay || !binding->glxContext)
    return call.wrong(XR_ERROR_GRAPHICS_DEVICE_INVALID, "no X display or no OpenGL context");
  session.gl_context = binding->glxContext;
  return XR_SUCCESS;
}

XrResult XRAPI_CALL create_session(XrInstance instance, const XrSessionCreateInfo* info,
                                   XrSession* handle) {
  XrCall call("xrCreateSession");
  if (call.early()) return *call.early();
  if (!call.has_instance(instance) ||
      !call.is_fine(info, XR_TYPE_SESSION_CREATE_INFO, {XR_TYPE_GRAPHICS_BINDING_OPENGL_XLIB_KHR}))
    return call.result();
  Runtime& rt = runtime();
  if (info->systemId != kSystem || !rt.first_system_ns)
    return call.wrong(XR_ERROR_SYSTEM_INVALID, "not the system of xrGetSystem");
  if (rt.sessions.size() > 0)
    return call.wrong(XR_ERROR_LIMIT_REACHED, "a session is there already");
  auto made = std::make_unique<Session>();
  if (const XrResult result = check_graphics(call, *info, *made); result != XR_SUCCESS)
    return result;
  rt.is_exit_wanted = false;
  Session& session = *made;
  *handle = rt.sessions.add(std::move(made));
  change_state(*handle, session, XR_SESSION_STATE_IDLE);
  advance_script();
  return XR_SUCCESS;
}

XrResult XRAPI_CALL destroy_session(XrSession handle) {
  XrCall call("xrDestroySession");
  Runtime& rt = runtime();
  const Session* session = rt.sessions.find(handle);
  if (!session) return call.wrong(XR_ERROR_HANDLE_INVALID, "the session is not alive");
  const auto is_its = [handle](const auto& child) { return child.session == handle; };
  std::vector<std::uint32_t> textures;
  for (const auto& [number, swapchain] : rt.swapchains)
    if (is_its(*swapchain))
      textures.insert(textures.end(), swapchain->textures.begin(), swapchain->textures.end());
  delete_textures(textures);
  rt.spaces.remove_if(is_its);
  rt.swapchains.remove_if(is_its);
  rt.hand_trackers.remove_if(is_its);
  rt.fb_trackers.remove_if(is_its);
  rt.bd_trackers.remove_if(is_its);
  if (session->has_actions)
    for (const auto& [number, set] : rt.action_sets) set->is_attached = false;
  rt.sessions.remove(handle);
  rt.frame_begun.notify_all();
  return XR_SUCCESS;
}

XrResult XRAPI_CALL begin_session(XrSession handle, const XrSessionBeginInfo* info) {
  XrCall call("xrBeginSession");
  if (call.early()) return *call.early();
  Session* session = call.session(handle);
  if (!session || !call.is_fine(info, XR_TYPE_SESSION_BEGIN_INFO)) return call.result();
  if (session->is_running) return call.wrong(XR_ERROR_SESSION_RUNNING, "the session runs already");
  if (session->state != XR_SESSION_STATE_READY)
    return call.wrong(XR_ERROR_SESSION_NOT_READY, "the session is not READY");
  if (!session->is_headless &&
      info->primaryViewConfigurationType != XR_VIEW_CONFIGURATION_TYPE_PRIMARY_STEREO)
    return call.wrong(XR_ERROR_VIEW_CONFIGURATION_TYPE_UNSUPPORTED, "only stereo is there");
  session->is_running = true;
  session->has_begun_frames = session->has_ended_a_frame = false;
  if (!runtime().clock_start_ns) runtime().clock_start_ns = now_ns();
  advance_script();
  return XR_SUCCESS;
}

XrResult XRAPI_CALL end_session(XrSession handle) {
  XrCall call("xrEndSession");
  if (call.early()) return *call.early();
  Session* session = call.session(handle);
  if (!session) return call.result();
  if (!session->is_running)
    return call.wrong(XR_ERROR_SESSION_NOT_RUNNING, "the session does not run");
  if (session->state != XR_SESSION_STATE_STOPPING)
    return call.wrong(XR_ERROR_SESSION_NOT_STOPPING, "the session is not STOPPING");
  session->is_running = false;
  session->waited_ns.reset();
  session->begun_ns.reset();
  runtime().frame_begun.notify_all();
  change_state(handle, *session, XR_SESSION_STATE_IDLE);
  advance_script();
  return XR_SUCCESS;
}

XrResult XRAPI_CALL request_exit(XrSession handle) {
  XrCall call("xrRequestExitSession");
  if (call.early()) return *call.early();
  Session* session = call.session(handle);
  if (!session) return call.result();
  if (!session->is_running)
    return call.wrong(XR_ERROR_SESSION_NOT_RUNNING, "the session does not run");
  session->is_exit_requested = true;
  advance_script();
  return XR_SUCCESS;
}

XrResult XRAPI_CALL to_time(XrInstance instance, const timespec* from, XrTime* into) {
  XrCall call("xrConvertTimespecTimeToTimeKHR");
  if (call.early()) return *call.early();
  if (!call.has_instance(instance)) return call.result();
  if (!from || !into) return call.wrong(XR_ERROR_VALIDATION_FAILURE, "a null pointer");
  *into = static_cast<XrTime>(from->tv_sec) * 1'000'000'000 + from->tv_nsec + kTimeOffset_ns;
  return XR_SUCCESS;
}

XrResult XRAPI_CALL from_time(XrInstance instance, XrTime from, timespec* into) {
  XrCall call("xrConvertTimeToTimespecTimeKHR");
  if (call.early()) return *call.early();
  if (!call.has_instance(instance) || !call.is_fine_time(from)) return call.result();
  if (from < kTimeOffset_ns) return call.wrong(XR_ERROR_TIME_INVALID, "a time before the clock's");
  into->tv_sec = (from - kTimeOffset_ns) / 1'000'000'000;
  into->tv_nsec = (from - kTimeOffset_ns) % 1'000'000'000;
  return XR_SUCCESS;
}

}  // namespace

void add_session_functions(XrFunctionMap& map) {
  add_function(map, "xrGetOpenGLGraphicsRequirementsKHR", gl_requirements,
               XR_KHR_OPENGL_ENABLE_EXTENSION_NAME);
  add_function(map, "xrCreateSession", create_session);
  add_function(map, "xrDestroySession", destroy_session);
  add_function(map, "xrBeginSession", begin_session);
  add_function(map, "xrEndSession", end_session);
  add_function(map, "xrRequestExitSession", request_exit);
}

void add_time_functions(XrFunctionMap& map) {
  add_function(map, "xrConvertTimespecTimeToTimeKHR", to_time,
               XR_KHR_CONVERT_TIMESPEC_TIME_EXTENSION_NAME);
  add_function(map, "xrConvertTimeToTimespecTimeKHR", from_time,
               XR_KHR_CONVERT_TIMESPEC_TIME_EXTENSION_NAME);
}

}  // namespace dance::test_xr
