// The numbers of a glTF file that is written, behind its accessors. Those of files of others are
// read by formats/gltf/glb_accessor.h.
//
// Units/frames: little-endian, as glTF has them.
// Ownership:    refers to the model that it fills.
// Threads:      none inside.
// Failure:      none.
// Source:       glTF 2.0, 3.6 Binary Data Storage.
#pragma once

#include <tiny_gltf.h>

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

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

}  // namespace dance
