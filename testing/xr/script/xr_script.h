// XrScript: what the OpenXR test runtime shall show and when it shall misbehave, as a text.
//
//   refresh 90                         pictures a second
//   fov -50 42 45 -48                  left right up down of the left eye, degrees; mirrored right
//   size 400 440                       recommended pixels of an eye
//   pictures 10                        with DANCE_XR_PICTURES: each tenth frame (default: all)
//   without XR_EXT_hand_tracking       the runtime has no such extension
//   system hands off | system body on  what the system's properties say (default: on, off)
//   body on                            the same as system body on
//   no stage                           no STAGE space, no bounds
//   no system [until 2.0]              xrGetSystem: unavailable; seconds since its first call
//   profile valve/index_controller     what the hands hold (default oculus/touch_controller); none
//   motion FILE                        CSV: seconds,point,x,y,z,qx,qy,qz,qw; beside the script
//   at T pose POINT x y z qx qy qz qw  a keyframe; linear and slerp between, held before and after
//   at T lose|guess|find POINT         neither valid nor tracked | valid, not tracked | both
//   at T nan|zero_quaternion POINT     for 0.2 s the pose is not a number | no rotation
//   at T press HAND INPUT [x [y]]      left|right; select menu trigger thumbstick a b squeeze
//   at T release HAND INPUT
//   at T hands flat|fist               the shape of the joints of both hands
//   at T focus on|off                  FOCUSED or VISIBLE
//   at T visible on|off                below VISIBLE: SYNCHRONIZED
//   at T stop | ready | exit           STOPPING | READY again | STOPPING, then EXITING
//   at T lose_session | lose_instance  the event at T, the errors 0.1 s later
//   at T bad_time zero|past|far|garbage   one predictedDisplayTime
//   at T jump x y z yaw                a new origin of LOCAL and STAGE in the old one; degrees
//   at T fail FUNCTION RESULT          its next call, as xrEndFrame XR_ERROR_RUNTIME_FAILURE
//
// T is in seconds since the first xrBeginSession under this script; what is `at 0` counts from the
// instance on. The time goes on over later sessions and instances. `#` begins a comment. Points are
// kTrackedPointNames; head and hands are there from the start, others from their first keyframe on.
//
// Units/frames: metres, seconds; poses in the stage as it was at first; quaternions x y z w.
// Ownership:    plain value.
// Threads:      none inside.
// Failure:      parse_script() and read_script() name file, line, word and cure.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.h"
#include "producers/trackers/tracker_frame.h"

namespace dance::test_xr {

enum class Tracking { kTracked, kGuessed, kLost };
enum class Input { kSelect, kMenu, kTrigger, kThumbstick, kA, kB, kSqueeze };
enum class Hand { kLeft, kRight };
constexpr double kGarbledTime_s = 0.2;

struct Keyframe {
  double time_s = 0.0;
  Eigen::Vector3d p_m = Eigen::Vector3d::Zero();
  Eigen::Quaterniond R = Eigen::Quaterniond::Identity();
};
struct TrackingChange {
  double time_s = 0.0;
  Tracking tracking = Tracking::kTracked;
};
struct GarbledPose {
  double time_s = 0.0;
  bool is_nan = true;  // else a quaternion of zeros
};
struct PointTrack {
  std::vector<Keyframe> keyframes;  // all three lists are sorted by time
  std::vector<TrackingChange> changes;
  std::vector<GarbledPose> garbled;
};

struct InputChange {
  double time_s = 0.0;
  Hand hand = Hand::kLeft;
  Input input = Input::kSelect;
  float x = 0.0f;
  float y = 0.0f;
};
struct ShapeChange {
  double time_s = 0.0;
  bool is_fist = false;
};

enum class EventKind {
  kFocus,
  kVisible,
  kStop,
  kReady,
  kExit,
  kLoseSession,
  kLoseInstance,
  kBadTime,
  kJump,
  kFail,
};
struct ScriptEvent {
  double time_s = 0.0;
  EventKind kind = EventKind::kFocus;
  bool is_on = false;
  std::string word;  // the kind of bad time, or the function that fails
  int result = 0;    // an XrResult
  Keyframe origin;   // of a jump
};

struct XrScript {
  double refresh_hz = 90.0;
  std::array<double, 4> fov_deg{-50.0, 42.0, 45.0, -48.0};
  std::array<int, 2> size_px{400, 440};
  int pictures_every = 1;
  std::vector<std::string> without;
  bool has_hands = true;
  bool has_body = false;
  bool has_stage = true;
  double no_system_until_s = 0.0;  // infinity: for ever
  std::string profile = "/interaction_profiles/oculus/touch_controller";
  std::array<PointTrack, kTrackedPointCount> points;
  std::vector<InputChange> inputs;
  std::vector<ShapeChange> shapes;
  std::vector<ScriptEvent> events;  // sorted by time
};

// The default: a dancer who stands still, everything is tracked.
XrScript default_script();
// `name` is what errors call the text, `folder` where its motion files are.
Result<XrScript> parse_script(std::string_view text, const std::string& name,
                              const std::string& folder);
Result<XrScript> read_script(const std::string& path);

}  // namespace dance::test_xr
