// The fingers of a rig: which joints below a hand are the three bones of each finger. Joints of the
// palm above them and joints at their tips are left out.
//
// Units/frames: places with no joint turned, in the file's units.
// Threads:      none inside.
// Failure:      fingers that are not found stay kNoJoint.
#pragma once

#include <span>
#include <vector>

#include "formats/bvh/rig/rig.h"
#include "formats/bvh/rig/rig_tree.h"

namespace dance {

// `chain` are the joints of one finger from the hand outwards. `begins_with_palm` is true where
// their names tell that the first is a joint of the palm.
std::span<const int> finger_bones_of(const RigTree& tree, int hand, const std::vector<int>& chain,
                                     bool is_thumb, bool begins_with_palm);

// Finds fingers by the shape of the hands that `rig` has: three to five chains, of which the thumb
// begins nearest to the wrist, and the index finger stands next to it.
void place_fingers_by_shape(const RigTree& tree, Rig& rig);

}  // namespace dance
