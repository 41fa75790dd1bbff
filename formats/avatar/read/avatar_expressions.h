// The expressions of a face, by VRM 1.0's names, as weights of morphs.
//
// Units/frames: weights 0 to 1.
// Ownership:    fills the model's expressions.
// Threads:      none inside.
// Failure:      what names no morph of the figure is left out; too many are cut with a note.
// Source:       VRM 1.0 expressions; VRM 0.x blendShapeMaster (Joy, Sorrow, A, Blink_L, …); for
//               files without either the eyelids by ARKit's names, so that figures blink.
#pragma once

#include "formats/avatar/read/avatar_source.h"
#include "formats/avatar/read/mesh/avatar_meshes.h"

namespace dance {

void read_expressions(AvatarSource& source, const std::vector<MeshMorphs>& morphs);

}  // namespace dance
