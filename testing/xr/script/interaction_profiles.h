// Which inputs and outputs OpenXR's interaction profiles have.
//
// Units/frames: none.
// Ownership:    none.
// Threads:      none inside; const.
// Failure:      a profile or path that is not known is not there.
// Source:       OpenXR 1.0, interaction profile paths; XR_HTCX_vive_tracker_interaction.
#pragma once

#include <string>
#include <string_view>

namespace dance::test_xr {

bool is_known_profile(std::string_view profile);
// `path` with its top-level path: /user/hand/left/input/x/click. The component may be left out.
bool has_profile_path(std::string_view profile, std::string_view top, std::string_view path);

}  // namespace dance::test_xr
