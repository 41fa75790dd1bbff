// libFuzzer target: any bytes as a ZED's calibration file.
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "core/base/assert.h"
#include "producers/camera/stereo/zed_ini.h"
#include "tests/fuzz_target.h"

DANCE_FUZZ_TARGET(zed_ini) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  dance::looks_like_zed_ini(text);
  for (const auto& [width, height] :
       {std::pair{1280, 720}, std::pair{672, 376}, std::pair{640, 360}}) {
    const auto rig = dance::parse_zed_ini(text, "fuzz.conf", width, height);
    if (!rig) {
      DANCE_ASSERT(!rig.error().what.empty());
      continue;
    }
    DANCE_ASSERT(rig->left.width_px == width && rig->right.height_px == height);
    DANCE_ASSERT(dance::checked(*rig, "fuzz").has_value());
  }
  return 0;
}
