#include "testing/xr/state/runtime_call.h"

#include <algorithm>
#include <cmath>
#include <cstdarg>
#include <cstring>

#include "testing/xr/state/runtime_events.h"

namespace dance::test_xr {

XrCall::XrCall(const char* function) : function_(function), lock_(runtime().mutex) {
  Runtime& rt = runtime();
  if (rt.has_instance) advance_script();
  const std::string name(function);
  if (const auto found = rt.failures.find(name); found != rt.failures.end()) {
    early_ = found->second;
    rt.failures.erase(found);
    return;
  }
  const bool is_lost =
      rt.instance_lost_at_s && script_now_s() >= *rt.instance_lost_at_s + kLossDelay_s;
  if (is_lost && !name.starts_with("xrDestroy") && !name.ends_with("ToString") &&
      !name.starts_with("xrEnumerateInstance") && name != "xrCreateInstance")
    early_ = XR_ERROR_INSTANCE_LOST;
}

void XrCall::misuse(const std::string& reason) const {
  runtime().record.line("misuse " + std::string(function_) + ": " + reason);
}

XrResult XrCall::wrong(XrResult result, const std::string& reason) const {
  misuse(reason);
  return result;
}

Session* XrCall::session(XrSession handle) {
  Session* session = runtime().sessions.find(handle);
  if (!session) {
    result_ = wrong(XR_ERROR_HANDLE_INVALID, "the session is not alive");
    return nullptr;
  }
  if (session->is_lost) {
    result_ = XR_ERROR_SESSION_LOST;
    return nullptr;
  }
  return session;
}

bool XrCall::has_instance(XrInstance handle) {
  const Runtime& rt = runtime();
  if (rt.has_instance && std::bit_cast<std::uint64_t>(handle) == rt.instance) return true;
  result_ = wrong(XR_ERROR_HANDLE_INVALID, "the instance is not alive");
  return false;
}

bool XrCall::has_extension(const char* name) {
  if (runtime().extensions.count(name)) return true;
  result_ = wrong(XR_ERROR_FUNCTION_UNSUPPORTED, std::string(name) + " was not enabled");
  return false;
}

bool XrCall::is_fine(const void* structure, XrStructureType type,
                     std::initializer_list<XrStructureType> may_follow) {
  result_ = XR_ERROR_VALIDATION_FAILURE;
  if (!structure) {
    misuse(text_of("a null pointer instead of a structure of type %d", type));
    return false;
  }
  const auto* base = static_cast<const XrBaseInStructure*>(structure);
  if (base->type != type) {
    misuse(text_of("a structure of type %d where %d is wanted", base->type, type));
    return false;
  }
  for (base = base->next; base; base = base->next) {
    if (std::find(may_follow.begin(), may_follow.end(), base->type) != may_follow.end()) continue;
    misuse(text_of("a structure of type %d in the next chain of %d", base->type, type));
    break;  // what it is made of is not known; OpenXR ignores such structures
  }
  result_ = XR_SUCCESS;
  return true;
}

bool XrCall::is_fine_pose(const XrPosef& pose, const char* what) {
  const XrQuaternionf& q = pose.orientation;
  const float norm = std::sqrt(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w);
  const bool is_finite = std::isfinite(pose.position.x) && std::isfinite(pose.position.y) &&
                         std::isfinite(pose.position.z) && std::isfinite(norm);
  if (is_finite && std::abs(norm - 1.0f) < 0.01f) return true;
  result_ =
      wrong(XR_ERROR_POSE_INVALID, text_of("%s: a quaternion of length %g or an infinite position",
                                           what, static_cast<double>(norm)));
  return false;
}

bool XrCall::is_fine_time(XrTime time) {
  if (time > 0) return true;
  result_ = wrong(XR_ERROR_TIME_INVALID, "a time of 0 or less");
  return false;
}

XrResult give_text(XrCall& call, const std::string& text, std::uint32_t capacity,
                   std::uint32_t* count, char* into) {
  std::string whole = text;
  whole.push_back('\0');
  return give_list(call, whole, capacity, count, into);
}

std::string text_of(const char* format, ...) {
  char text[512];
  va_list arguments;
  va_start(arguments, format);
  std::vsnprintf(text, sizeof text, format, arguments);
  va_end(arguments);
  return text;
}

}  // namespace dance::test_xr
