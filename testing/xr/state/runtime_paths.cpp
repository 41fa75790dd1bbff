#include "testing/xr/state/runtime_paths.h"

#include <algorithm>

#include "testing/xr/state/runtime_call.h"

namespace dance::test_xr {
namespace {

constexpr std::string_view kRole = "/user/vive_tracker_htcx/role/";
constexpr std::array<std::string_view, kTrackedPointCount> kTopLevels{
    "/user/head",
    "/user/hand/left",
    "/user/hand/right",
    "/user/vive_tracker_htcx/role/waist",
    "/user/vive_tracker_htcx/role/left_foot",
    "/user/vive_tracker_htcx/role/right_foot",
    "/user/vive_tracker_htcx/role/left_elbow",
    "/user/vive_tracker_htcx/role/right_elbow",
    "/user/vive_tracker_htcx/role/left_knee",
    "/user/vive_tracker_htcx/role/right_knee",
    "/user/vive_tracker_htcx/role/chest"};
// Roles of trackers that are no points of a dancer.
constexpr std::array<std::string_view, 5> kOtherRoles{"handheld_object", "left_shoulder",
                                                      "right_shoulder", "camera", "keyboard"};

}  // namespace

bool is_fine_path(std::string_view text) {
  if (text.size() < 2 || text.size() >= XR_MAX_PATH_LENGTH) return false;
  if (text.front() != '/' || text.back() == '/') return false;
  if (text.find("//") != std::string_view::npos) return false;
  return std::all_of(text.begin(), text.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '-' || c == '_' || c == '.' ||
           c == '/';
  });
}

XrPath path_of(const std::string& text) {
  auto& paths = runtime().paths;
  const auto found = std::find(paths.begin(), paths.end(), text);
  if (found != paths.end()) return static_cast<XrPath>(found - paths.begin() + 1);
  paths.push_back(text);
  return paths.size();
}

std::string text_of_path(XrPath path) {
  const auto& paths = runtime().paths;
  return path == XR_NULL_PATH || path > paths.size() ? std::string() : paths[path - 1];
}

std::string top_level(const std::string& path) {
  const auto begins = [&](std::string_view top) {
    return path == top || path.starts_with(std::string(top) + "/");
  };
  for (const std::string_view top : kTopLevels)
    if (begins(top)) return std::string(top);
  for (const std::string_view role : kOtherRoles) {
    const std::string top = std::string(kRole) + std::string(role);
    if (begins(top)) return top;
  }
  return begins("/user/gamepad") ? "/user/gamepad" : "";
}

std::string top_level(TrackedPoint point) { return std::string(kTopLevels[index_of(point)]); }

std::optional<TrackedPoint> point_of_top_level(std::string_view path) {
  const auto found = std::find(kTopLevels.begin(), kTopLevels.end(), path);
  if (found == kTopLevels.end()) return std::nullopt;
  return static_cast<TrackedPoint>(found - kTopLevels.begin());
}

std::vector<TrackedPoint> connected_trackers() {
  std::vector<TrackedPoint> points;
  for (std::size_t i = index_of(TrackedPoint::kHips); i < kTrackedPointCount; ++i) {
    const auto point = static_cast<TrackedPoint>(i);
    if (is_connected_at(runtime().script, point, script_now_s())) points.push_back(point);
  }
  return points;
}

XrViveTrackerPathsHTCX tracker_paths_of(TrackedPoint point) {
  XrViveTrackerPathsHTCX paths{XR_TYPE_VIVE_TRACKER_PATHS_HTCX, nullptr, 0, 0};
  paths.persistentPath =
      path_of(text_of("/devices/htc/vive_trackerlhr-%08d", static_cast<int>(10 + index_of(point))));
  paths.rolePath = path_of(top_level(point));
  return paths;
}

}  // namespace dance::test_xr
