#include "producers/trackers/tracker_frame.h"

#include <cmath>

#include "core/pose/pose.h"

namespace dance {

bool is_valid(const TrackerFrame& frame) {
  for (std::size_t i = 0; i < kTrackedPointCount; ++i) {
    if ((frame.presence >> i & 1u) == 0) continue;
    if (!frame.p_WT_m[i].allFinite() || frame.p_WT_m[i].norm() > kMaxStageDistance_m) return false;
    // Not a rotation for NaN either.
    if (!(std::abs(frame.R_WT[i].norm() - 1.0f) <= 0.01f)) return false;
  }
  return true;
}

}  // namespace dance
