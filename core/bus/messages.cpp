#include "core/bus/messages.h"

#include <algorithm>

namespace dance {

bool is_valid(const GuestStats& s) {
  const auto is_fine = [](float figure) { return !std::isinf(figure); };
  return std::all_of(s.gap_p50_ms.begin(), s.gap_p50_ms.end(), is_fine) &&
         std::all_of(s.gap_p99_ms.begin(), s.gap_p99_ms.end(), is_fine) &&
         is_fine(s.newest_p50_ms) && is_fine(s.newest_p99_ms) && is_fine(s.age_p50_ms) &&
         is_fine(s.age_p99_ms) && is_fine(s.arrival_hz) && is_fine(s.stage_hz) &&
         is_fine(s.shown_hz) && is_fine(s.jitter_ms) && is_fine(s.loss_percent) &&
         is_fine(s.horizon_p50_ms) && is_fine(s.horizon_p99_ms) && is_fine(s.error_mean_mm) &&
         is_fine(s.error_p95_mm) && is_fine(s.hips_error_mm) && is_fine(s.beat_ms) &&
         is_fine(s.beat_share) && is_fine(s.bytes_per_second) && is_fine(s.bytes_per_pose);
}

}  // namespace dance
