// Reads a stranger's accessors, with every index, offset, stride and count checked before a byte is
// touched.
//
// Units/frames: numbers as the file has them.
// Ownership:    copies.
// Threads:      none inside.
// Failure:      names the accessor and what is wrong with it.
// Source:       glTF 2.0, 3.6.2 Accessors (sparse ones too) and 3.11 Animations (integers for
//               -1..1).
#pragma once

#include <tiny_gltf.h>

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/base/result.h"

namespace dance {

// The type of an accessor of that many components: 1 to 4, or 16 for matrices.
int glb_type_of(std::size_t components);

// The floats of one accessor of an animation, `components` for each element (integers are
// normalised to -1..1). At most `most_values` of them; all are finite.
Result<std::vector<float>> read_floats(const tinygltf::Model& model, int accessor,
                                       std::size_t components, std::size_t most_values);

// Likewise of a vertex's attribute: integers are normalised where the accessor says so, and it may
// be sparse, over zeros too.
Result<std::vector<float>> read_attribute(const tinygltf::Model& model, int accessor,
                                          std::size_t components, std::size_t most_values);

// Indices of vertices, or of joints: unsigned integers of any size.
Result<std::vector<std::uint32_t>> read_integers(const tinygltf::Model& model, int accessor,
                                                 std::size_t components, std::size_t most_values);

// How many elements an accessor says it has; 0 where there is no such accessor.
std::size_t element_count(const tinygltf::Model& model, int accessor);

// The bytes behind a view: of a picture.
Result<std::span<const std::uint8_t>> bytes_of_view(const tinygltf::Model& model, int view);

}  // namespace dance
