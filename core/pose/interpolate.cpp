#include "core/pose/interpolate.h"

#include <algorithm>
#include <cmath>

namespace dance {

Pose interpolate(const Pose& a, const Pose& b, float fraction) {
  Pose out = fraction < 0.5f ? a : b;  // what cannot be between: sequence, presence, stamps
  for (std::size_t i = 0; i < kBoneCount; ++i)
    out.R_PB[i] = a.R_PB[i].slerp(fraction, b.R_PB[i]).normalized();
  out.p_WH_m = a.p_WH_m + fraction * (b.p_WH_m - a.p_WH_m);
  out.confidence = std::clamp(a.confidence + fraction * (b.confidence - a.confidence), 0.0f, 1.0f);
  const Duration step = b.capture_time - a.capture_time;
  const MonoTime stamped = out.capture_time;
  out.capture_time =
      a.capture_time + Duration::seconds(step.as_seconds() * static_cast<double>(fraction));
  // Stamps are those of the nearer pose, moved with the capture time, so that each step keeps its age.
  for (MonoTime& hop : out.hops)
    if (hop.is_set()) hop += out.capture_time - stamped;
  out.music_beats = a.music_beats + static_cast<double>(fraction) * (b.music_beats - a.music_beats);
  return out;
}

float largest_angle_rad(const Pose& a, const Pose& b) {
  float largest = 0.0f;
  for (std::size_t i = 0; i < kBoneCount; ++i)
    largest = std::max(largest, a.R_PB[i].angularDistance(b.R_PB[i]));
  return largest;
}

}  // namespace dance
