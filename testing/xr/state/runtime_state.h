// The state of the OpenXR test runtime: one instance, its sessions, and all that they made.
//
// Units/frames: XrTime is CLOCK_MONOTONIC in nanoseconds plus kTimeOffset_ns. Poses are in the
//               stage as it was at first.
// Ownership:    Runtime owns everything; one in the process.
// Threads:      each function of OpenXR holds the runtime's mutex (runtime_call.h), but while it
//               sleeps.
// Failure:      none here.
#pragma once

#include <openxr/openxr.h>

#include <array>
#include <condition_variable>
#include <deque>
#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "producers/xr/openxr_more.h"
#include "testing/xr/script/xr_record.h"
#include "testing/xr/script/xr_scene.h"
#include "testing/xr/script/xr_script.h"
#include "testing/xr/state/handle_table.h"

namespace dance::test_xr {

constexpr XrTime kTimeOffset_ns = 7'000'000'000'000;
constexpr XrSystemId kSystem = 0x51;
constexpr double kLossDelay_s = 0.1;

struct Action {
  XrActionSet set = XR_NULL_HANDLE;
  XrActionType type = XR_ACTION_TYPE_BOOLEAN_INPUT;
  std::string name;
  std::vector<XrPath> subactions;
};
struct ActionSet {
  std::string name;
  bool is_attached = false;
  std::set<std::string> names;
};
struct Binding {
  XrAction action;
  std::string path;  // /user/hand/left/input/grip/pose
};
struct InputValue {
  bool is_active = false;
  float x = 0.0f;
  float y = 0.0f;
  bool has_changed = false;
  XrTime changed_ns = 0;
};

enum class SpaceKind { kView, kLocal, kStage, kAction };
struct Space {
  XrSession session = XR_NULL_HANDLE;
  SpaceKind kind = SpaceKind::kView;
  XrAction action = XR_NULL_HANDLE;
  XrPath subaction = XR_NULL_PATH;
  Pose offset = Pose::Identity();
};

struct Swapchain {
  XrSession session = XR_NULL_HANDLE;
  XrSwapchainCreateInfo info{};
  std::vector<std::uint32_t> textures;
  std::uint32_t next = 0;              // the image that is acquired next
  std::deque<std::uint32_t> acquired;  // oldest first
  bool is_waited = false;              // the oldest of them
  int released = -1;                   // the newest image that may be shown
};

struct HandTracker {
  XrSession session = XR_NULL_HANDLE;
  Hand hand = Hand::kLeft;
};
struct BodyTracker {
  XrSession session = XR_NULL_HANDLE;
  std::uint32_t joints = 0;
};

struct Session {
  XrSessionState state = XR_SESSION_STATE_UNKNOWN;
  bool is_headless = true;
  void* gl_context = nullptr;  // a GLXContext
  bool is_running = false;
  bool has_begun_frames = false;
  bool has_ended_a_frame = false;
  bool is_exit_requested = false;
  std::optional<double> lost_at_s;
  bool is_lost = false;
  // Frames. A waited frame is one that xrWaitFrame announced and xrBeginFrame did not take.
  std::optional<XrTime> waited_ns;
  std::optional<XrTime> begun_ns;
  bool is_time_bad = false;
  std::int64_t last_tick = -1;
  std::deque<XrTime> predicted_ns;
  std::int64_t frames = 0;
  // Actions.
  bool has_actions = false;
  bool has_synced = false;
  std::map<std::pair<XrAction, XrPath>, InputValue> inputs;
  std::map<std::string, std::string> profiles;  // top-level path -> interaction profile
};

struct Origin {
  XrTime since_ns;
  Pose pose;  // of LOCAL's and STAGE's origin in the first stage
};

struct Runtime {
  std::mutex mutex;
  std::condition_variable frame_begun;
  XrRecord record;
  XrScript script = default_script();
  std::string script_path;
  std::string pictures_folder;

  // The script's clock, which outlives instances.
  std::optional<XrTime> clock_start_ns;
  std::optional<XrTime> first_system_ns;
  std::size_t next_event = 0;
  std::deque<std::string> bad_times;  // still to be reported, one in a frame
  std::map<std::string, XrResult> failures;
  std::vector<Origin> origins;

  bool has_instance = false;
  std::uint64_t instance = 0;
  std::optional<double> instance_lost_at_s;
  std::set<std::string> extensions;
  bool has_asked_requirements = false;
  std::vector<std::string> paths;  // XrPath 1 is the first
  std::deque<XrEventDataBuffer> events;
  std::deque<XrViveTrackerPathsHTCX> tracker_paths;  // what events point to
  std::set<TrackedPoint> announced;
  std::set<std::string> located;
  std::map<std::string, std::vector<Binding>> bindings;  // interaction profile -> bindings

  // What the script wants of sessions.
  bool is_focus_wanted = true;
  bool is_visible_wanted = true;
  bool is_stop_wanted = false;
  bool is_exit_wanted = false;

  HandleTable<XrSession, Session> sessions;
  HandleTable<XrSpace, Space> spaces;
  HandleTable<XrActionSet, ActionSet> action_sets;
  HandleTable<XrAction, Action> actions;
  HandleTable<XrSwapchain, Swapchain> swapchains;
  HandleTable<XrHandTrackerEXT, HandTracker> hand_trackers;
  HandleTable<XrBodyTrackerFB, BodyTracker> fb_trackers;
  HandleTable<XrBodyTrackerBD, BodyTracker> bd_trackers;
};

Runtime& runtime();

XrTime now_ns();
// Seconds of the script; 0 until a session runs.
double script_time_s(XrTime time_ns);
double script_now_s();

}  // namespace dance::test_xr
