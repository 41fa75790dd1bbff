// Joint limits for predicted poses. Each joint's rotation is split into swing and twist about its
// bone, and what exceeds a range saturates softly: knees and elbows do not bend backwards, heads do
// not turn round. The ranges are wide: in the mocap they were measured on, only broken frames reach
// them.
//
// Units/frames: rotation vectors in each bone's parent as core/pose/pose.h has them.
// Ownership:    constants only.
// Threads:      none.
// Failure:      none. A pose within the limits is unchanged, bit for bit.
#pragma once

#include "core/pose/pose.h"

namespace dance {

// How many joints were beyond their range.
int limit_joints(Pose& pose);

}  // namespace dance
