#include "testing/xr/state/runtime_bindings.h"

#include <algorithm>
#include <cmath>

#include "testing/xr/state/runtime_paths.h"

namespace dance::test_xr {
namespace {

constexpr const char* kSimple = "/interaction_profiles/khr/simple_controller";
constexpr const char* kTracker = "/interaction_profiles/htc/vive_tracker_htcx";

// trigger of /user/hand/left/input/trigger/value
std::string_view source_name(std::string_view path, std::string_view top) {
  const std::string_view rest = path.substr(top.size() + 1);  // input/trigger/value
  const auto slash = rest.find('/');
  if (slash == std::string_view::npos) return {};
  const std::string_view name = rest.substr(slash + 1);
  return name.substr(0, name.find('/'));
}

std::optional<Input> input_of(std::string_view name) {
  struct Named {
    std::string_view name;
    Input input;
  };
  constexpr std::array<Named, 10> kNames{{{"select", Input::kSelect},
                                          {"menu", Input::kMenu},
                                          {"trigger", Input::kTrigger},
                                          {"thumbstick", Input::kThumbstick},
                                          {"trackpad", Input::kThumbstick},
                                          {"a", Input::kA},
                                          {"x", Input::kA},
                                          {"b", Input::kB},
                                          {"y", Input::kB},
                                          {"squeeze", Input::kSqueeze}}};
  for (const Named& named : kNames)
    if (named.name == name) return named.input;
  return std::nullopt;
}

// A click of the stick, a touch or the system's button are never scripted.
std::array<float, 2> value_of(const std::string& path, const std::string& top) {
  const auto input = input_of(source_name(path, top));
  if (!input || path.ends_with("/touch") || path.ends_with("/force")) return {};
  const bool is_stick = *input == Input::kThumbstick;
  if (is_stick && path.ends_with("/click")) return {};
  const Hand hand = top == "/user/hand/left" ? Hand::kLeft : Hand::kRight;
  std::array<float, 2> value = input_at(runtime().script, hand, *input, script_now_s());
  if (is_stick && path.ends_with("/y")) value = {value[1], 0.0f};
  if (is_stick && path.ends_with("/x")) value[1] = 0.0f;
  return value;
}

bool is_there(const std::string& top) {
  const auto point = point_of_top_level(top);
  return point && is_connected_at(runtime().script, *point, script_now_s());
}

void take_stronger(const std::array<float, 2>& value, InputValue& best) {
  if (std::hypot(value[0], value[1]) <= std::hypot(best.x, best.y)) return;
  best.x = value[0];
  best.y = value[1];
}

}  // namespace

void choose_profiles(Session& session) {
  const Runtime& rt = runtime();
  std::string hands;
  if (rt.bindings.count(rt.script.profile))
    hands = rt.script.profile;
  else if (!rt.script.profile.empty() && rt.bindings.count(kSimple))
    hands = kSimple;
  for (const char* top : {"/user/hand/left", "/user/hand/right"})
    if (!hands.empty()) session.profiles[top] = hands;
  for (std::size_t i = index_of(TrackedPoint::kHips); i < kTrackedPointCount; ++i)
    if (rt.bindings.count(kTracker))
      session.profiles[top_level(static_cast<TrackedPoint>(i))] = kTracker;
}

std::vector<std::string> sources_of(const Session& session, XrAction action, XrPath subaction) {
  std::vector<std::string> sources;
  const std::string wanted = text_of_path(subaction);
  for (const auto& [profile, bindings] : runtime().bindings) {
    for (const Binding& binding : bindings) {
      const std::string top = top_level(binding.path);
      const auto chosen = session.profiles.find(top);
      if (binding.action != action || chosen == session.profiles.end() ||
          chosen->second != profile || (!wanted.empty() && wanted != top))
        continue;
      sources.push_back(binding.path);
    }
  }
  return sources;
}

std::optional<PoseSource> pose_source(XrSession handle, XrAction action, XrPath subaction) {
  const Session* session = runtime().sessions.find(handle);
  if (!session || session->state != XR_SESSION_STATE_FOCUSED) return std::nullopt;
  const auto value = session->inputs.find({action, subaction});
  if (value == session->inputs.end() || !value->second.is_active) return std::nullopt;
  for (const std::string& path : sources_of(*session, action, subaction)) {
    const std::string top = top_level(path);
    if (is_there(top)) return PoseSource{top, path.find("/input/aim") != std::string::npos};
  }
  return std::nullopt;
}

InputValue read_input(const Session& session, XrAction handle, const Action& action,
                      XrPath subaction) {
  InputValue now;
  for (const std::string& path : sources_of(session, handle, subaction)) {
    const std::string top = top_level(path);
    if (!is_there(top)) continue;
    now.is_active = true;
    if (action.type != XR_ACTION_TYPE_POSE_INPUT && action.type != XR_ACTION_TYPE_VIBRATION_OUTPUT)
      take_stronger(value_of(path, top), now);
  }
  if (action.type == XR_ACTION_TYPE_BOOLEAN_INPUT) now = {now.is_active, now.x > 0.5f ? 1.f : 0.f};
  const auto before = session.inputs.find({handle, subaction});
  if (before == session.inputs.end() || !now.is_active) return now;
  now.has_changed =
      before->second.is_active && (now.x != before->second.x || now.y != before->second.y);
  now.changed_ns = now.has_changed ? now_ns() : before->second.changed_ns;
  return now;
}

}  // namespace dance::test_xr
