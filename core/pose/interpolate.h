// The pose between two poses: slerp of each bone the short way, the rest linear. With the poses
// around the two, cubic and without corners: linear interpolation of 30 poses a second is visibly
// rough on a 60 Hz stage.
//
// Units/frames: fraction 0 is a, 1 is b; outside 0..1 the linear one extrapolates.
// Ownership:    plain values, no allocation.
// Threads:      none inside.
// Failure:      none; musical time is interpolated only where both have it. A bone that turns by
//               more than some 45 degrees from one pose to the next is interpolated linearly.
// Source:       the cubic: Catmull and Rom 1974 for uneven times, its slopes limited as Fritsch and
//               Carlson 1980 have it, so that nothing overshoots where a motion stops; on
//               quaternions it is projected onto the sphere.
#pragma once

#include "core/pose/pose.h"

namespace dance {

Pose interpolate(const Pose& a, const Pose& b, float fraction);
// Rotations, the short way; all else is that of the nearer one.
Hands interpolate(const Hands& a, const Hands& b, float fraction);

// The same on a cubic. `before` comes before a and `after` after b, in time too; either may be
// null, and is ignored when nearer than 0.3 of the step. Fraction within 0..1.
Pose interpolate_smoothly(const Pose* before, const Pose& a, const Pose& b, const Pose* after,
                          float fraction);

// The largest angle between the same bone of two poses, rad: how different they look.
float largest_angle_rad(const Pose& a, const Pose& b);

}  // namespace dance
