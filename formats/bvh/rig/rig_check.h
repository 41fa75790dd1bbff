// Checks a rig against the figure: names of joints are trusted only if their bones have the
// proportions of a human body.
//
// Units/frames: lengths in the file's units.
// Threads:      none inside.
// Failure:      none.
#pragma once

#include <string>
#include <vector>

#include "formats/bvh/rig/rig.h"
#include "formats/bvh/rig/rig_tree.h"

namespace dance {

// Names the fault of a rig that has all needed bones but is not human. Empty if left and right are
// apart, limbs are long and alike, and none skips a joint. may_skip[j] is true if a limb may have
// joint j between its bones; the list may be empty.
std::string rig_fault(const RigTree& tree, const Rig& rig, const std::vector<bool>& may_skip);

}  // namespace dance
