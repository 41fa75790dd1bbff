// Finds a human in a tree of joints by its shape alone, for files with unknown names: two branches
// of the same length below, a spine, two branches of the same length above, and feet that point
// forwards.
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
