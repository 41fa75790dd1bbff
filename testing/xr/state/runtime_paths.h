// Paths of OpenXR, and what they are called for the points of a dancer.
//
// Units/frames: none.
// Ownership:    works on runtime().
// Threads:      the caller holds the runtime's lock.
// Failure:      a path that is not known is empty or XR_NULL_PATH.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "testing/xr/state/runtime_state.h"

namespace dance::test_xr {

bool is_fine_path(std::string_view text);
XrPath path_of(const std::string& text);  // made where it is new
std::string text_of_path(XrPath path);    // empty: no path
// The top-level path of a path: /user/hand/left, /user/vive_tracker_htcx/role/waist; or empty.
std::string top_level(const std::string& path);
std::string top_level(TrackedPoint point);
std::optional<TrackedPoint> point_of_top_level(std::string_view path);
std::vector<TrackedPoint> connected_trackers();
XrViveTrackerPathsHTCX tracker_paths_of(TrackedPoint point);

}  // namespace dance::test_xr
