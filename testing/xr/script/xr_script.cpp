#include "testing/xr/script/xr_script.h"

#include <algorithm>
#include <fstream>
#include <limits>
#include <sstream>

#include "core/base/take_line.h"
#include "testing/xr/script/xr_script_events.h"
#include "testing/xr/script/xr_words.h"

namespace dance::test_xr {
namespace {

Result<void> set_refresh(const Words& words, XrScript& script) {
  DANCE_TRY(const auto values, read_numbers(words, 1, 1, "'refresh HZ', as refresh 90"));
  if (values[0] < 1.0 || values[0] > 1000.0) return fail("a refresh rate is of 1 to 1000 Hz");
  script.refresh_hz = values[0];
  return {};
}

Result<void> set_fov(const Words& words, XrScript& script) {
  DANCE_TRY(const auto fov, read_numbers(words, 1, 4, "'fov LEFT RIGHT UP DOWN', in degrees"));
  const bool is_inside =
      std::all_of(fov.begin(), fov.end(), [](double x) { return std::abs(x) < 89.0; });
  if (!is_inside || fov[0] >= fov[1] || fov[3] >= fov[2])
    return fail("a field of view has left < right and down < up, within 89 degrees: -50 42 45 -48");
  std::copy(fov.begin(), fov.end(), script.fov_deg.begin());
  return {};
}

Result<void> set_size(const Words& words, XrScript& script) {
  DANCE_TRY(const auto size, read_numbers(words, 1, 2, "'size WIDTH HEIGHT', in pixels"));
  for (const double pixels : size)
    if (pixels < 1.0 || pixels > 8192.0) return fail("a size is of 1 to 8192 pixels");
  script.size_px = {static_cast<int>(size[0]), static_cast<int>(size[1])};
  return {};
}

Result<void> set_pictures(const Words& words, XrScript& script) {
  DANCE_TRY(const auto every, read_numbers(words, 1, 1, "'pictures EVERY', as pictures 10"));
  if (every[0] < 1.0 || every[0] > 1e6) return fail("pictures are of every 1st to 1000000th frame");
  script.pictures_every = static_cast<int>(every[0]);
  return {};
}

Result<void> set_no(const Words& words, XrScript& script) {
  if (words.size() == 2 && words[1] == "stage") {
    script.has_stage = false;
    return {};
  }
  if (words.size() == 2 && words[1] == "system") {
    script.no_system_until_s = std::numeric_limits<double>::infinity();
    return {};
  }
  if (words.size() == 4 && words[1] == "system" && words[2] == "until") {
    DANCE_TRY(script.no_system_until_s, read_number(words[3]));
    return {};
  }
  return fail("write 'no stage', 'no system' or 'no system until SECONDS'");
}

Result<void> set_system(const Words& words, XrScript& script) {
  const bool is_body = words.size() == 2 && words[0] == "body";
  const Words said = is_body ? Words{"system", "body", words[1]} : words;
  const bool is_fine = said.size() == 3 && (said[1] == "hands" || said[1] == "body") &&
                       (said[2] == "on" || said[2] == "off");
  if (!is_fine) return fail("write 'system hands on|off', 'system body on|off' or 'body on|off'");
  (said[1] == "hands" ? script.has_hands : script.has_body) = said[2] == "on";
  return {};
}

Result<void> read_motion(const Words& words, const std::string& folder, XrScript& script) {
  if (words.size() != 2) return fail("write 'motion FILE'");
  const std::string path = folder + "/" + std::string(words[1]);
  std::ifstream file(path);
  if (!file) return fail(path + " cannot be read; it is looked for beside the script");
  std::string line;
  for (int number = 1; std::getline(file, line); ++number) {
    Words cells = split_words(line, ", \r\t");
    if (cells.empty() || cells[0].front() == '#') continue;
    const std::string where = path + ":" + std::to_string(number) + ": ";
    if (cells.size() != 9) return fail(where + "write seconds,point,x,y,z,qx,qy,qz,qw");
    cells.insert(cells.begin(), "at");
    cells.insert(cells.begin() + 2, "pose");
    if (const auto added = add_event(cells, script); !added)
      return fail(where + added.error().what);
  }
  return {};
}

Result<void> apply_line(const Words& words, const std::string& folder, XrScript& script) {
  const std::string_view verb = words[0];
  if (verb == "at") return add_event(words, script);
  if (verb == "refresh") return set_refresh(words, script);
  if (verb == "fov") return set_fov(words, script);
  if (verb == "size") return set_size(words, script);
  if (verb == "pictures") return set_pictures(words, script);
  if (verb == "no") return set_no(words, script);
  if (verb == "system" || verb == "body") return set_system(words, script);
  if (verb == "motion") return read_motion(words, folder, script);
  if (verb == "without") {
    if (words.size() != 2 || !words[1].starts_with("XR_"))
      return fail("write 'without EXTENSION', as without XR_EXT_hand_tracking");
    script.without.emplace_back(words[1]);
    return {};
  }
  if (verb == "profile") {
    const bool is_none = words.size() == 2 && words[1] == "none";
    if (words.size() != 2 || (!is_none && words[1].find('/') == std::string_view::npos))
      return fail(
          "write 'profile VENDOR/NAME', as profile valve/index_controller, or profile none");
    script.profile = is_none ? "" : "/interaction_profiles/" + std::string(words[1]);
    return {};
  }
  return fail("'" + std::string(verb) +
              "' begins no line; lines begin with refresh, fov, size, pictures, without, system, "
              "body, no, profile, motion or at");
}

template <class List>
void sort_by_time(List& list) {
  std::stable_sort(list.begin(), list.end(),
                   [](const auto& a, const auto& b) { return a.time_s < b.time_s; });
}

void sort_all(XrScript& script) {
  for (PointTrack& track : script.points) {
    sort_by_time(track.keyframes);
    sort_by_time(track.changes);
    sort_by_time(track.garbled);
  }
  sort_by_time(script.inputs);
  sort_by_time(script.shapes);
  sort_by_time(script.events);
}

// In OpenXR a dancer who stands at the origin looks along -Z. In the hands by the sides the grip's
// -Z, out of the thumb's side, points forward, too: no rotation.
void add_default(TrackedPoint point, const Eigen::Vector3d& p_m, XrScript& script) {
  auto& keyframes = script.points[index_of(point)].keyframes;
  if (keyframes.empty()) keyframes.push_back({0.0, p_m, Eigen::Quaterniond::Identity()});
}

void add_defaults(XrScript& script) {
  add_default(TrackedPoint::kHead, {0.0, 1.65, 0.0}, script);
  add_default(TrackedPoint::kLeftHand, {-0.25, 0.75, -0.05}, script);
  add_default(TrackedPoint::kRightHand, {0.25, 0.75, -0.05}, script);
}

}  // namespace

XrScript default_script() {
  XrScript script;
  add_defaults(script);
  return script;
}

Result<XrScript> parse_script(std::string_view text, const std::string& name,
                              const std::string& folder) {
  XrScript script;
  for (int number = 1; !text.empty(); ++number) {
    std::string_view line = take_line(text);
    line = line.substr(0, line.find('#'));
    const Words words = split_words(line, " \t");
    if (words.empty()) continue;
    if (const auto applied = apply_line(words, folder, script); !applied)
      return fail(name + ":" + std::to_string(number) + ": " + applied.error().what);
  }
  sort_all(script);
  add_defaults(script);
  return script;
}

Result<XrScript> read_script(const std::string& path) {
  std::ifstream file(path);
  if (!file) return fail(path + ": cannot be read; does DANCE_XR_SCRIPT name a file?");
  std::ostringstream text;
  text << file.rdbuf();
  const auto slash = path.find_last_of('/');
  return parse_script(text.str(), path, slash == std::string::npos ? "." : path.substr(0, slash));
}

}  // namespace dance::test_xr
