// MotionClip: a recorded dance on the canonical skeleton, every frame of it in memory.
//
// Units/frames: frames are 1/frame_hz apart, the first at time 0; poses in W, metres, as
//               core/pose/pose.h says; capture times are left unset; the player stamps them.
// Ownership:    owns its frames.
// Threads:      none inside; read-only once made.
// Failure:      sample() of an empty clip is our bug.
#pragma once

#include <vector>

#include "core/base/time.h"
#include "core/pose/pose.h"
#include "core/pose/skeleton.h"

namespace dance {

struct MotionClip {
  Skeleton skeleton;
  double frame_hz = 60.0;
  std::vector<Pose> frames;
  std::vector<Hands> hands;  // as many as frames, or none

  Duration length() const {
    return Duration::seconds(static_cast<double>(frames.size()) / frame_hz);
  }
};

// What follows the end of a clip.
enum class ClipEnd { kHold, kLoop };

// The pose at time t from the clip's beginning, interpolated between frames. kLoop starts again at
// the first frame. Leaves sequence, clock, capture time and stamps of `out` alone.
void sample_clip(const MotionClip& clip, Duration t, ClipEnd end, Pose& out);

}  // namespace dance
