// Recognises figures that write_bvh() and write_glb() made: the bones of core/pose/bone.h by their
// names, and nothing else but their ends, in T-pose and metres. Their rotations are canonical as
// they stand, so reading them again changes nothing.
//
// Threads: none inside.
// Failure: none.
#pragma once

#include "formats/bvh/bvh.h"

namespace dance {

bool is_canonical(const Bvh& bvh);

}  // namespace dance
