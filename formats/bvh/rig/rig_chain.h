// Places the trunk of a rig: hips, spine, chest and neck are known by what they join, not by their
// names, which differ most of all between tools.
//
// Threads: none inside.
// Failure: leaves out missing bones; false where legs and arms do not meet in one trunk.
#pragma once

#include <vector>

#include "formats/bvh/rig/rig.h"
#include "formats/bvh/rig/rig_tree.h"

namespace dance {

// The limbs of `rig` must be set. Where `head` is kNoJoint it is searched above the arms; `is_neck`
// tells per joint whether its name says neck (may be empty).
bool place_trunk(const RigTree& tree, int head, const std::vector<bool>& is_neck, Rig& rig);

}  // namespace dance
