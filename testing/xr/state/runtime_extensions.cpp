#include "testing/xr/state/runtime_extensions.h"

#include <algorithm>

#include "testing/xr/state/runtime_state.h"

namespace dance::test_xr {

std::vector<OfferedExtension> offered_extensions() {
  std::vector<OfferedExtension> offered{
      {"XR_KHR_opengl_enable", 10},
      {XR_MND_HEADLESS_EXTENSION_NAME, XR_MND_headless_SPEC_VERSION},
      {"XR_KHR_convert_timespec_time", 1},
      {XR_EXT_HAND_TRACKING_EXTENSION_NAME, XR_EXT_hand_tracking_SPEC_VERSION},
      {XR_HTCX_VIVE_TRACKER_INTERACTION_EXTENSION_NAME,
       XR_HTCX_vive_tracker_interaction_SPEC_VERSION},
      {XR_FB_BODY_TRACKING_EXTENSION_NAME, XR_FB_body_tracking_SPEC_VERSION},
      {XR_META_BODY_TRACKING_FULL_BODY_EXTENSION_NAME,
       XR_META_body_tracking_full_body_SPEC_VERSION},
      {XR_BD_BODY_TRACKING_EXTENSION_NAME, XR_BD_body_tracking_SPEC_VERSION}};
  const auto& without = runtime().script.without;
  std::erase_if(offered, [&](const OfferedExtension& extension) {
    return std::find(without.begin(), without.end(), extension.name) != without.end();
  });
  return offered;
}

bool is_offered(std::string_view name) {
  const auto offered = offered_extensions();
  return std::any_of(offered.begin(), offered.end(),
                     [&](const OfferedExtension& extension) { return name == extension.name; });
}

}  // namespace dance::test_xr
