// The numbers of a glTF file, behind its accessors: GlbStore packs those that are written,
// read_floats() reads a stranger's with every index, offset and count checked.
//
// Units/frames: little-endian, as glTF has them.
// Ownership:    GlbStore refers to the model that it fills; read_floats() copies.
// Threads:      none inside.
// Failure:      read_floats() names the accessor and what is wrong with it.
// Source:       glTF 2.0, 3.6 Binary Data Storage and 3.11 Animations (integers for -1..1).
#pragma once

#include <tiny_gltf.h>

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/base/result.h"

namespace dance {

// What an accessor of a vertex is used for: glTF wants views of vertices, of indices and of other
// data to be apart.
enum class GlbUse : std::uint8_t { kData, kVertices, kIndices };

class GlbStore {
 public:
  explicit GlbStore(tinygltf::Model& model);

  // Each gives the index of the new accessor. `components` is 1 to 4, or 16 for matrices.
  int add_floats(std::span<const float> values, std::size_t components, GlbUse use,
                 bool has_bounds = false);
  int add_bytes(std::span<const std::uint8_t> values, bool is_normalized);  // of four each
  int add_shorts(std::span<const std::uint16_t> values);                    // of four each
  // Vectors of `count` vertices that are zero but for some: vertices[i], ascending, has values[i].
  int add_sparse(std::size_t count, std::span<const std::uint32_t> vertices,
                 std::span<const Eigen::Vector3f> values);
  int add_indices(std::span<const std::uint32_t> values);

  // The index of a new buffer view that holds a file as it is, such as a picture.
  int add_file(std::span<const std::uint8_t> file);

  std::size_t bytes() const { return data().size(); }

 private:
  std::vector<unsigned char>& data() const;
  int add_view(const void* values, std::size_t bytes, GlbUse use);
  int add_accessor(int view, int component_type, int type, std::size_t count);

  tinygltf::Model& model_;
};

// The floats of one accessor, `components` for each element (integers are normalised to -1..1).
// At most `most_values` of them; all are finite.
Result<std::vector<float>> read_floats(const tinygltf::Model& model, int accessor,
                                       std::size_t components, std::size_t most_values);

}  // namespace dance
