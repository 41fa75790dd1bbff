#include "producers/xr/xr_session.h"

#include <algorithm>

namespace dance {
namespace {

constexpr XrPosef kNoOffset{{0.0f, 0.0f, 0.0f, 1.0f}, {0.0f, 0.0f, 0.0f}};

}  // namespace

Result<std::unique_ptr<XrDancerSession>> XrDancerSession::create(const XrRuntime& runtime,
                                                                 const void* graphics) {
  std::unique_ptr<XrDancerSession> session(new XrDancerSession(runtime));
  if (auto opened = session->open(graphics); !opened) return tl::make_unexpected(opened.error());
  return session;
}

XrDancerSession::~XrDancerSession() {
  // With it everything that belongs to it.
  if (session_ != XR_NULL_HANDLE) xrDestroySession(session_);
}

Result<void> XrDancerSession::open(const void* graphics) {
  is_headless_ = graphics == nullptr;
  XrSessionCreateInfo info{};
  info.type = XR_TYPE_SESSION_CREATE_INFO;
  info.next = graphics;
  info.systemId = runtime_.system();
  if (auto made = checked(xrCreateSession(runtime_.instance(), &info, &session_), "a session");
      !made)
    return made;
  has_stage_ = offers(XR_REFERENCE_SPACE_TYPE_STAGE);
  DANCE_TRY(base_,
            make_space(has_stage_ ? XR_REFERENCE_SPACE_TYPE_STAGE : XR_REFERENCE_SPACE_TYPE_LOCAL));
  DANCE_TRY(view_, make_space(XR_REFERENCE_SPACE_TYPE_VIEW));
  return {};
}

bool XrDancerSession::offers(XrReferenceSpaceType type) const {
  std::uint32_t count = 0;
  if (XR_FAILED(xrEnumerateReferenceSpaces(session_, 0, &count, nullptr))) return false;
  std::vector<XrReferenceSpaceType> types(count, XR_REFERENCE_SPACE_TYPE_MAX_ENUM);
  if (XR_FAILED(xrEnumerateReferenceSpaces(session_, count, &count, types.data()))) return false;
  return std::find(types.begin(), types.end(), type) != types.end();
}

Result<XrSpace> XrDancerSession::make_space(XrReferenceSpaceType type) const {
  XrReferenceSpaceCreateInfo info{};
  info.type = XR_TYPE_REFERENCE_SPACE_CREATE_INFO;
  info.referenceSpaceType = type;
  info.poseInReferenceSpace = kNoOffset;
  XrSpace space = XR_NULL_HANDLE;
  if (auto made = checked(xrCreateReferenceSpace(session_, &info, &space), "a space"); !made)
    return tl::make_unexpected(made.error());
  return space;
}

void XrDancerSession::note(XrResult result) {
  if (result == XR_ERROR_SESSION_LOST || result == XR_ERROR_INSTANCE_LOST ||
      result == XR_ERROR_RUNTIME_FAILURE || result == XR_ERROR_HANDLE_INVALID) {
    is_running_.store(false, std::memory_order_release);
    is_focused_.store(false, std::memory_order_release);
    if (over_ == Over::kNot) over_ = Over::kLost;
  }
}

void XrDancerSession::poll() {
  // A runtime that never runs out of events would hold up everything.
  constexpr int kMostEvents = 64;
  for (int i = 0; i < kMostEvents; ++i) {
    XrEventDataBuffer event{};
    event.type = XR_TYPE_EVENT_DATA_BUFFER;
    const XrResult polled = xrPollEvent(runtime_.instance(), &event);
    note(polled);
    if (polled != XR_SUCCESS) return;
    if (event.type == XR_TYPE_EVENT_DATA_SESSION_STATE_CHANGED) {
      const auto& changed = reinterpret_cast<const XrEventDataSessionStateChanged&>(event);
      if (changed.session == session_) take(changed.state);
    }
    if (event.type == XR_TYPE_EVENT_DATA_INSTANCE_LOSS_PENDING) note(XR_ERROR_INSTANCE_LOST);
    if (event.type == XR_TYPE_EVENT_DATA_INTERACTION_PROFILE_CHANGED) ++profile_changes_;
    if (event.type == XR_TYPE_EVENT_DATA_REFERENCE_SPACE_CHANGE_PENDING) {
      const auto& change = reinterpret_cast<const XrEventDataReferenceSpaceChangePending&>(event);
      const auto own = has_stage_ ? XR_REFERENCE_SPACE_TYPE_STAGE : XR_REFERENCE_SPACE_TYPE_LOCAL;
      if (change.referenceSpaceType != own) continue;
      moves_.push({change.changeTime, change.poseValid == XR_TRUE, change.poseInPreviousSpace});
      recentres_.fetch_add(1, std::memory_order_acq_rel);
    }
  }
}

void XrDancerSession::take(XrSessionState state) {
  is_visible_ = state == XR_SESSION_STATE_VISIBLE || state == XR_SESSION_STATE_FOCUSED;
  was_focused_ = was_focused_ || state == XR_SESSION_STATE_FOCUSED;
  const bool counts = is_headless_ && !was_focused_ && state != XR_SESSION_STATE_STOPPING &&
                      state != XR_SESSION_STATE_IDLE;
  is_focused_.store(state == XR_SESSION_STATE_FOCUSED || counts, std::memory_order_release);
  if (state == XR_SESSION_STATE_READY) {
    XrSessionBeginInfo info{};
    info.type = XR_TYPE_SESSION_BEGIN_INFO;
    info.primaryViewConfigurationType = XR_VIEW_CONFIGURATION_TYPE_PRIMARY_STEREO;
    const XrResult begun = xrBeginSession(session_, &info);
    note(begun);
    is_running_.store(XR_SUCCEEDED(begun), std::memory_order_release);
  }
  if (state == XR_SESSION_STATE_STOPPING) {
    is_running_.store(false, std::memory_order_release);
    note(xrEndSession(session_));
  }
  if (state == XR_SESSION_STATE_EXITING && over_ == Over::kNot) over_ = Over::kEnded;
  if (state == XR_SESSION_STATE_LOSS_PENDING) note(XR_ERROR_SESSION_LOST);
}

void XrDancerSession::ask_to_end() {
  if (is_running()) note(xrRequestExitSession(session_));
}

}  // namespace dance
