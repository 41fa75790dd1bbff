// The materials of an avatar, with the pictures of their base colours.
//
// Units/frames: colours linear; uv as glTF has them, v down.
// Ownership:    fills materials and pictures of the model.
// Threads:      none inside.
// Failure:      too many materials are an error. A number out of its range is brought into it; a
//               picture that cannot be decoded is left out with a note.
// Source:       glTF 2.0, KHR_texture_transform, VRMC_materials_mtoon 1.0, VRM 0.x materials.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "formats/avatar/read/avatar_source.h"

namespace dance {

// Which of a vertex's uv the picture of a material takes, and how it is placed: uv' = M uv + t.
struct MaterialUv {
  int set = 0;
  Eigen::Matrix2f turn = Eigen::Matrix2f::Identity();
  Eigen::Vector2f offset = Eigen::Vector2f::Zero();
};

// One for each material of the model.
Result<std::vector<MaterialUv>> read_materials(AvatarSource& source);

}  // namespace dance
