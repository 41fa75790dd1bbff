// The corrections C_B of a reference pose: each canonical bone's rotation in W when the captured
// figure is in its reference pose. Arms that hang, legs that slant and feet that point outwards in
// the reference are turned from the T-pose the shortest way, so that no twist is added.
//
// Units/frames: metres in W.
// Ownership:    plain values.
// Threads:      none inside.
// Failure:      none; a bone without a direction keeps its parent's correction.
#pragma once

#include "formats/bvh/rig/rig_reference.h"

namespace dance {

// Whether a hand's end, from the wrist, may be that of its fingers. Some tools let End Sites of
// hands point straight down, which no hand of a reference pose does.
bool goes_on_from_forearm(const Eigen::Vector3d& forearm, const Eigen::Vector3d& end);

// Fills C and C_finger from the reference's figure, R_WF and metres_per_unit.
void find_corrections(const Bvh& bvh, const Rig& rig, RigReference& reference);

}  // namespace dance
