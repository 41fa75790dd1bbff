// The morph targets of meshes, of which only the vertices that move are kept.
//
// Units/frames: in the axes of their mesh, as its vertices.
// Ownership:    fills the model's morphs.
// Threads:      none inside.
// Failure:      too many morphs, or too many moving vertices, are an error.
// Source:       glTF 2.0, 3.7.2.2 Morph Targets; their names where exporters put them
//               (extras.targetNames).
#pragma once

#include "formats/avatar/read/avatar_source.h"
#include "formats/avatar/read/mesh/avatar_meshes.h"

namespace dance {

// Empty morphs, one for each target of the mesh.
Result<MeshMorphs> begin_morphs(AvatarSource& source, int node, int mesh);

// Adds what the targets of a primitive move, whose vertices in the model begin at `first`.
Result<void> read_targets(AvatarSource& source, const tinygltf::Primitive& primitive,
                          std::uint32_t first, std::uint32_t count, const MeshMorphs& morphs);

}  // namespace dance
