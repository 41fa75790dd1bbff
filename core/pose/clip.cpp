#include "core/pose/clip.h"

#include <algorithm>
#include <cmath>

#include "core/base/assert.h"
#include "core/pose/interpolate.h"

namespace dance {

void sample_clip(const MotionClip& clip, Duration t, ClipEnd end, Pose& out) {
  DANCE_ASSERT(!clip.frames.empty());
  const std::size_t count = clip.frames.size();
  double position = std::max(0.0, t.as_seconds() * clip.frame_hz);
  if (end == ClipEnd::kLoop)
    position = std::fmod(position, static_cast<double>(count));
  else
    position = std::min(position, static_cast<double>(count - 1));
  const auto first = std::min(static_cast<std::size_t>(position), count - 1);
  // The loop is not continuous from the last frame to the first: hold the last.
  const std::size_t second = std::min(first + 1, count - 1);
  const Pose between = interpolate(clip.frames[first], clip.frames[second],
                                   static_cast<float>(position - static_cast<double>(first)));
  out.R_PB = between.R_PB;
  out.p_WH_m = between.p_WH_m;
  out.presence = between.presence;
  out.confidence = between.confidence;
  out.music_beats = between.music_beats;
}

}  // namespace dance
