// The triangles of a primitive, with or without indices, as a list, a strip or a fan.
//
// Units/frames: three indices of the primitive's vertices each, counter-clockwise from outside.
// Ownership:    returns a new list.
// Threads:      none inside.
// Failure:      an index outside the vertices is an error; points and lines have no triangles.
// Source:       glTF 2.0, 3.7.2.1 (primitive modes).
#pragma once

#include "formats/avatar/read/avatar_source.h"

namespace dance {

// `left` is how many triangles may be read yet, those without an area too, and is counted down.
Result<std::vector<std::uint32_t>> read_triangles(AvatarSource& source,
                                                  const tinygltf::Primitive& primitive,
                                                  std::size_t vertices, std::size_t& left);

}  // namespace dance
