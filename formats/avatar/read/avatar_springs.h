// What swings at an avatar, hair, ribbons, skirts, and what it stays out of.
//
// Units/frames: as AvatarModel; gravity's direction in W, of the figure as it was turned.
// Ownership:    fills the model's springs and colliders.
// Threads:      none inside.
// Failure:      a chain that names wrong nodes, or bones of the body, ends there or is left out;
//               too many are cut, with a note.
// Source:       VRMC_springBone 1.0 (chains of joints, the last of which only marks the end);
//               VRM 0.x secondaryAnimation (roots, of which all that is below swings; ends 7 cm
//               long; z of vectors the other way round).
#pragma once

#include "formats/avatar/read/avatar_source.h"

namespace dance {

void read_springs(AvatarSource& source);

}  // namespace dance
