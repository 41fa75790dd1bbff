// The pose between two poses: slerp of each bone the short way, straight lines for the rest.
//
// Units/frames: fraction 0 is a, 1 is b; outside 0..1 it extrapolates.
// Ownership:    plain values, no allocation.
// Threads:      none inside.
// Failure:      none; musical time is interpolated only where both have it.
#pragma once

#include "core/pose/pose.h"

namespace dance {

Pose interpolate(const Pose& a, const Pose& b, float fraction);

// The largest angle between the same bone of two poses, rad: how different they look.
float largest_angle_rad(const Pose& a, const Pose& b);

}  // namespace dance
