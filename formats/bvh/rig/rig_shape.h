// Finds a human in a tree of joints by its shape alone, for files with unknown names: two pairs of
// branches that mirror each other, bone by bone, are legs and arms; a spine lies between them; feet
// and knees point forwards, without rotations or in the frames in which the figure stands.
//
// Threads: none inside.
// Failure: nullopt where there is no such shape, or where left and right cannot be told apart.
#pragma once

#include <optional>

#include "formats/bvh/rig/rig.h"
#include "formats/bvh/rig/rig_tree.h"

namespace dance {

std::optional<Rig> find_rig_by_shape(const RigTree& tree);

}  // namespace dance
