#include "testing/xr/script/xr_script_events.h"

#include <openxr/openxr_reflection.h>

#include <algorithm>
#include <array>
#include <numbers>

namespace dance::test_xr {
namespace {

// What every `at` line has: its time, its verb, and what follows.
struct AtLine {
  double time_s;
  std::string_view verb;
  const Words& words;
  std::string_view word(std::size_t i) const {
    return 3 + i < words.size() ? words[3 + i] : std::string_view();
  }
  std::size_t count() const { return words.size() - 3; }
};

Result<TrackedPoint> read_point(std::string_view word) {
  const auto found = std::find(kTrackedPointNames.begin(), kTrackedPointNames.end(), word);
  if (found != kTrackedPointNames.end())
    return static_cast<TrackedPoint>(found - kTrackedPointNames.begin());
  std::string names;
  for (const std::string_view name : kTrackedPointNames) names += " " + std::string(name);
  return fail("'" + std::string(word) + "' is no point; points are" + names);
}

Result<Input> read_input(std::string_view word) {
  constexpr std::array<std::string_view, 7> kNames{"select", "menu", "trigger", "thumbstick",
                                                   "a",      "b",    "squeeze"};
  const auto found = std::find(kNames.begin(), kNames.end(), word);
  if (found != kNames.end()) return static_cast<Input>(found - kNames.begin());
  return fail("'" + std::string(word) +
              "' is no input; inputs are select, menu, trigger, thumbstick, a, b, squeeze");
}

Result<void> add_pose(const AtLine& line, XrScript& script) {
  constexpr const char* kRule = "'at T pose POINT x y z qx qy qz qw'";
  if (line.count() != 8) return fail(std::string("write ") + kRule);
  DANCE_TRY(const TrackedPoint point, read_point(line.word(0)));
  DANCE_TRY(const auto x, read_numbers(line.words, 4, 7, kRule));
  const Eigen::Quaterniond R(x[6], x[3], x[4], x[5]);
  if (std::abs(R.norm() - 1.0) > 0.01)
    return fail("the quaternion has a length of " + std::to_string(R.norm()) +
                "; write x y z w of length 1");
  script.points[index_of(point)].keyframes.push_back(
      {line.time_s, {x[0], x[1], x[2]}, R.normalized()});
  return {};
}

Result<void> add_tracking(const AtLine& line, XrScript& script) {
  if (line.count() != 1) return fail("write 'at T " + std::string(line.verb) + " POINT'");
  DANCE_TRY(const TrackedPoint point, read_point(line.word(0)));
  PointTrack& track = script.points[index_of(point)];
  if (line.verb == "nan" || line.verb == "zero_quaternion")
    track.garbled.push_back({line.time_s, line.verb == "nan"});
  else if (line.verb == "lose")
    track.changes.push_back({line.time_s, Tracking::kLost});
  else
    track.changes.push_back(
        {line.time_s, line.verb == "find" ? Tracking::kTracked : Tracking::kGuessed});
  return {};
}

Result<void> add_input(const AtLine& line, XrScript& script) {
  const bool is_pressed = line.verb == "press";
  if (line.count() < 2 || line.count() > (is_pressed ? 4u : 2u))
    return fail("write 'at T press left|right INPUT [x [y]]' or 'at T release left|right INPUT'");
  if (line.word(0) != "left" && line.word(0) != "right")
    return fail("'" + std::string(line.word(0)) + "' is no hand; write left or right");
  InputChange change;
  change.time_s = line.time_s;
  change.hand = line.word(0) == "left" ? Hand::kLeft : Hand::kRight;
  DANCE_TRY(change.input, read_input(line.word(1)));
  if (is_pressed) change.x = 1.0f;
  std::array<float*, 2> values{&change.x, &change.y};
  for (std::size_t i = 0; i + 2 < line.count(); ++i) {
    DANCE_TRY(const double value, read_number(line.word(i + 2)));
    if (std::abs(value) > 1.0) return fail("the value of an input is of -1 to 1");
    *values[i] = static_cast<float>(value);
  }
  script.inputs.push_back(change);
  return {};
}

Result<void> add_shape(const AtLine& line, XrScript& script) {
  if (line.count() != 1 || (line.word(0) != "flat" && line.word(0) != "fist"))
    return fail("write 'at T hands flat|fist'");
  script.shapes.push_back({line.time_s, line.word(0) == "fist"});
  return {};
}

Result<void> add_jump(const AtLine& line, XrScript& script) {
  DANCE_TRY(const auto x, read_numbers(line.words, 3, 4, "'at T jump x y z yaw', yaw in degrees"));
  ScriptEvent event;
  event.time_s = line.time_s;
  event.kind = EventKind::kJump;
  event.origin.p_m = {x[0], x[1], x[2]};
  event.origin.R = Eigen::AngleAxisd(x[3] * std::numbers::pi / 180.0, Eigen::Vector3d::UnitY());
  script.events.push_back(event);
  return {};
}

int result_of(std::string_view name) {
#define DANCE_XR_RESULT(text, value) \
  if (name == #text) return value;
  XR_LIST_ENUM_XrResult(DANCE_XR_RESULT)
#undef DANCE_XR_RESULT
      return 0;
}

Result<void> add_fail(const AtLine& line, XrScript& script) {
  if (line.count() != 2 || !line.word(0).starts_with("xr"))
    return fail("write 'at T fail FUNCTION RESULT', as xrWaitFrame XR_ERROR_RUNTIME_FAILURE");
  ScriptEvent event;
  event.time_s = line.time_s;
  event.kind = EventKind::kFail;
  event.word = line.word(0);
  event.result = result_of(line.word(1));
  if (event.result == 0)
    return fail(
        "'" + std::string(line.word(1)) +
        "' is no result but XR_SUCCESS; write one of OpenXR's, as XR_ERROR_RUNTIME_FAILURE");
  script.events.push_back(event);
  return {};
}

Result<void> add_bad_time(const AtLine& line, XrScript& script) {
  constexpr std::array<std::string_view, 4> kKinds{"zero", "past", "far", "garbage"};
  const bool is_known = std::find(kKinds.begin(), kKinds.end(), line.word(0)) != kKinds.end();
  if (line.count() != 1 || !is_known) return fail("write 'at T bad_time zero|past|far|garbage'");
  ScriptEvent event;
  event.time_s = line.time_s;
  event.kind = EventKind::kBadTime;
  event.word = line.word(0);
  script.events.push_back(event);
  return {};
}

struct PlainEvent {
  std::string_view verb;
  EventKind kind;
  bool is_switch;
};
constexpr std::array<PlainEvent, 7> kPlainEvents{
    {{"focus", EventKind::kFocus, true},
     {"visible", EventKind::kVisible, true},
     {"stop", EventKind::kStop, false},
     {"ready", EventKind::kReady, false},
     {"exit", EventKind::kExit, false},
     {"lose_session", EventKind::kLoseSession, false},
     {"lose_instance", EventKind::kLoseInstance, false}}};

Result<void> add_plain(const PlainEvent& plain, const AtLine& line, XrScript& script) {
  const std::string verb(plain.verb);
  if (plain.is_switch && (line.count() != 1 || (line.word(0) != "on" && line.word(0) != "off")))
    return fail("write 'at T " + verb + " on|off'");
  if (!plain.is_switch && line.count() != 0) return fail("write 'at T " + verb + "' alone");
  ScriptEvent event;
  event.time_s = line.time_s;
  event.kind = plain.kind;
  event.is_on = line.word(0) == "on";
  script.events.push_back(event);
  return {};
}

}  // namespace

Result<void> add_event(const Words& words, XrScript& script) {
  if (words.size() < 3) return fail("write 'at SECONDS WHAT …', as at 1.5 lose left-hand");
  DANCE_TRY(const double time_s, read_number(words[1]));
  if (time_s < 0.0) return fail("a time is of 0 seconds or more");
  const AtLine line{time_s, words[2], words};
  for (const PlainEvent& plain : kPlainEvents)
    if (plain.verb == line.verb) return add_plain(plain, line, script);
  if (line.verb == "pose") return add_pose(line, script);
  if (line.verb == "press" || line.verb == "release") return add_input(line, script);
  if (line.verb == "hands") return add_shape(line, script);
  if (line.verb == "jump") return add_jump(line, script);
  if (line.verb == "fail") return add_fail(line, script);
  if (line.verb == "bad_time") return add_bad_time(line, script);
  for (const std::string_view verb : {"lose", "guess", "find", "nan", "zero_quaternion"})
    if (verb == line.verb) return add_tracking(line, script);
  return fail("'" + std::string(line.verb) +
              "' happens never; what can: pose, lose, guess, find, nan, zero_quaternion, press, "
              "release, hands, focus, visible, stop, ready, exit, lose_session, lose_instance, "
              "bad_time, jump, fail");
}

}  // namespace dance::test_xr
