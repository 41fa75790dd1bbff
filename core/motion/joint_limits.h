// Limits of joints: what is predicted stays a body. Each joint's turn is taken apart into twist
// about its bone and swing, and what goes beyond a range saturates softly: knees and elbows do not
// bend backwards, heads do not turn round. The ranges are wide: in the mocap that they were
// measured on, only frames where the capture itself is broken reach them.
//
// Units/frames: rotation vectors in each bone's parent as core/pose/pose.h has them.
// Ownership:    constants only.
// Threads:      none.
// Failure:      none. A pose within the limits is not touched, bit for bit.
#pragma once

#include "core/pose/pose.h"

namespace dance {

// How many joints were beyond their range.
int limit_joints(Pose& pose);

}  // namespace dance
