// The meshes of an avatar: vertices, triangles, parts, and the targets of morphs.
//
// Units/frames: as AvatarModel.
// Ownership:    fills the model of the source.
// Threads:      none inside.
// Failure:      names what is wrong; meshes that do not follow the figure are left out with a note.
#pragma once

#include "formats/avatar/read/avatar_source.h"
#include "formats/avatar/read/look/avatar_materials.h"

namespace dance {

// Which morphs of the model are the targets of which mesh: one entry for each node that shows it.
struct MeshMorphs {
  int node = -1;  // of the file
  int mesh = -1;
  std::uint32_t first = 0;
  std::uint32_t count = 0;
};

struct ReadMeshes {
  std::vector<MeshMorphs> morphs;
};

Result<ReadMeshes> read_meshes(AvatarSource& source, std::vector<MaterialUv> uvs);

}  // namespace dance
