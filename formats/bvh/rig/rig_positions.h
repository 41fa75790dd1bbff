// Decides what the position channels of a file's inner joints hold, by the floor that the feet find
// over all frames: a root above the hips makes both readings possible, and one lets the dancer
// float by the OFFSET of the hips.
//
// Threads: none inside.
// Failure: none; without inner position channels both readings are the same.
#pragma once

#include "formats/bvh/bvh_motion.h"
#include "formats/bvh/rig/rig.h"

namespace dance {

BvhPositions positions_of(const Bvh& bvh, const Rig& rig);

}  // namespace dance
