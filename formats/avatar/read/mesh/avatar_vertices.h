// The vertices of one primitive: places, normals, uv, and the joints they follow.
//
// Units/frames: places in the axes of their mesh, as the file has them (of quantised meshes the
//               joints' matrices hold the scale).
// Ownership:    returns new vertices.
// Threads:      none inside.
// Failure:      names what is wrong; missing uv are 0, missing normals are left 0 and told.
// Source:       glTF 2.0, 3.7.2 Meshes and 3.7.3.3 Skinned Mesh Attributes; KHR_mesh_quantization.
#pragma once

#include "formats/avatar/read/avatar_source.h"
#include "formats/avatar/read/look/avatar_materials.h"

namespace dance {

struct VertexBlock {
  std::vector<AvatarVertex> vertices;
  bool has_normals = false;
};

// `joints` are those of the skin; of a mesh without a skin the one of its node.
Result<VertexBlock> read_vertices(AvatarSource& source, const tinygltf::Primitive& primitive,
                                  const MaterialUv& uv, const std::vector<std::uint16_t>& joints,
                                  bool is_skinned, std::size_t most);

// The four largest weights, as parts of 255.
struct FourWeights {
  std::array<std::uint16_t, 4> joints{};
  std::array<std::uint8_t, 4> weights{255, 0, 0, 0};
};
FourWeights four_largest(std::span<const std::uint16_t> joints, std::span<const float> weights);

}  // namespace dance
