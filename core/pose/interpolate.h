// The pose between two poses: slerp of each bone the short way, straight lines for the rest. Where
// the poses around the two are known, on curves that go through all of them without a corner:
// thirty poses a second joined by straight lines tremble on a stage of sixty.
//
// Units/frames: fraction 0 is a, 1 is b; outside 0..1 the straight one extrapolates.
// Ownership:    plain values, no allocation.
// Threads:      none inside.
// Failure:      none; musical time is interpolated only where both have it. A bone that turns by
//               more than some 45 degrees from one pose to the next goes the straight way.
// Source:       the cubic: Catmull and Rom 1974 for uneven times, its slopes limited as Fritsch and
//               Carlson 1980 have it, so that nothing swings over where a motion stops; on
//               quaternions it is projected onto the sphere.
#pragma once

#include "core/pose/pose.h"

namespace dance {

Pose interpolate(const Pose& a, const Pose& b, float fraction);

// The same on a cubic. `before` comes before a and `after` after b, in time too; either may be
// null, and counts as such where it is nearer than 0.3 of the step. Fraction within 0..1.
Pose interpolate_smoothly(const Pose* before, const Pose& a, const Pose& b, const Pose* after,
                          float fraction);

// The largest angle between the same bone of two poses, rad: how different they look.
float largest_angle_rad(const Pose& a, const Pose& b);

}  // namespace dance
