// The canonical skeleton of a captured dancer: every offset taken from the reference pose, so that
// forward kinematics puts the joints where the file has them.
//
// Units/frames: metres, T-pose axes.
// Threads:      none inside.
// Failure:      missing bones are placed between existing ones, or get average lengths.
#pragma once

#include "core/pose/skeleton.h"
#include "formats/bvh/rig/rig_reference.h"

namespace dance {

Skeleton learn_skeleton(const Bvh& bvh, const Rig& rig, const RigReference& reference);

}  // namespace dance
