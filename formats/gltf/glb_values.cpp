#include "formats/gltf/glb_values.h"

#include <algorithm>
#include <bit>
#include <limits>

#include "core/base/assert.h"
#include "formats/gltf/glb_accessor.h"

namespace dance {
namespace {

static_assert(std::endian::native == std::endian::little, "glTF is little-endian, and copied");

constexpr std::size_t kAlignment_bytes = 4;

}  // namespace

GlbStore::GlbStore(tinygltf::Model& model) : model_(model) {
  if (model_.buffers.empty()) model_.buffers.emplace_back();
}

std::vector<unsigned char>& GlbStore::data() const { return model_.buffers.front().data; }

int GlbStore::add_view(const void* values, std::size_t bytes, GlbUse use) {
  auto& out = data();
  out.resize((out.size() + kAlignment_bytes - 1) / kAlignment_bytes * kAlignment_bytes, 0);
  tinygltf::BufferView view;
  view.buffer = 0;
  view.byteOffset = out.size();
  view.byteLength = bytes;
  if (use == GlbUse::kVertices) view.target = TINYGLTF_TARGET_ARRAY_BUFFER;
  if (use == GlbUse::kIndices) view.target = TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER;
  const auto* begin = static_cast<const unsigned char*>(values);
  out.insert(out.end(), begin, begin + bytes);
  model_.bufferViews.push_back(std::move(view));
  return static_cast<int>(model_.bufferViews.size()) - 1;
}

int GlbStore::add_accessor(int view, int component_type, int type, std::size_t count) {
  tinygltf::Accessor accessor;
  accessor.bufferView = view;
  accessor.byteOffset = 0;
  accessor.componentType = component_type;
  accessor.type = type;
  accessor.count = count;
  model_.accessors.push_back(std::move(accessor));
  return static_cast<int>(model_.accessors.size()) - 1;
}

int GlbStore::add_floats(std::span<const float> values, std::size_t components, GlbUse use,
                         bool has_bounds) {
  DANCE_ASSERT(!values.empty() && values.size() % components == 0, values.size(), components);
  const int view = add_view(values.data(), values.size_bytes(), use);
  const int index = add_accessor(view, TINYGLTF_COMPONENT_TYPE_FLOAT, glb_type_of(components),
                                 values.size() / components);
  if (!has_bounds) return index;
  tinygltf::Accessor& accessor = model_.accessors[static_cast<std::size_t>(index)];
  for (std::size_t c = 0; c < components; ++c) {
    float least = values[c];
    float most = values[c];
    for (std::size_t i = c; i < values.size(); i += components) {
      least = std::min(least, values[i]);
      most = std::max(most, values[i]);
    }
    accessor.minValues.push_back(static_cast<double>(least));
    accessor.maxValues.push_back(static_cast<double>(most));
  }
  return index;
}

int GlbStore::add_bytes(std::span<const std::uint8_t> values, bool is_normalized) {
  const int view = add_view(values.data(), values.size(), GlbUse::kVertices);
  const int index = add_accessor(view, TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE, TINYGLTF_TYPE_VEC4,
                                 values.size() / 4);
  model_.accessors[static_cast<std::size_t>(index)].normalized = is_normalized;
  return index;
}

int GlbStore::add_shorts(std::span<const std::uint16_t> values) {
  const int view = add_view(values.data(), values.size_bytes(), GlbUse::kVertices);
  return add_accessor(view, TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT, TINYGLTF_TYPE_VEC4,
                      values.size() / 4);
}

int GlbStore::add_sparse(std::size_t count, std::span<const std::uint32_t> vertices,
                         std::span<const Eigen::Vector3f> values) {
  DANCE_ASSERT(!vertices.empty() && vertices.size() == values.size() && vertices.back() < count,
               vertices.size(), count);
  const bool is_small = count <= std::numeric_limits<std::uint16_t>::max();
  const std::vector<std::uint16_t> small(vertices.begin(), vertices.end());
  const int index = add_accessor(-1, TINYGLTF_COMPONENT_TYPE_FLOAT, TINYGLTF_TYPE_VEC3, count);
  const int index_view = is_small ? add_view(small.data(), 2 * small.size(), GlbUse::kData)
                                  : add_view(vertices.data(), vertices.size_bytes(), GlbUse::kData);
  const int value_view = add_view(values.data(), values.size_bytes(), GlbUse::kData);
  tinygltf::Accessor& accessor = model_.accessors[static_cast<std::size_t>(index)];
  accessor.sparse.isSparse = true;
  accessor.sparse.count = static_cast<int>(vertices.size());
  accessor.sparse.indices.bufferView = index_view;
  accessor.sparse.indices.byteOffset = 0;
  accessor.sparse.indices.componentType =
      is_small ? TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT : TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
  accessor.sparse.values.bufferView = value_view;
  accessor.sparse.values.byteOffset = 0;
  Eigen::Vector3f least =
      vertices.size() < count ? Eigen::Vector3f(Eigen::Vector3f::Zero()) : values.front();
  Eigen::Vector3f most = least;
  for (const Eigen::Vector3f& value : values) {
    least = least.cwiseMin(value);
    most = most.cwiseMax(value);
  }
  for (int axis = 0; axis < 3; ++axis) {
    accessor.minValues.push_back(static_cast<double>(least[axis]));
    accessor.maxValues.push_back(static_cast<double>(most[axis]));
  }
  return index;
}

int GlbStore::add_file(std::span<const std::uint8_t> file) {
  return add_view(file.data(), file.size(), GlbUse::kData);
}

int GlbStore::add_indices(std::span<const std::uint32_t> values) {
  const std::uint32_t most = *std::max_element(values.begin(), values.end());
  // 65535 restarts a strip on some machines, and is forbidden.
  if (most < std::numeric_limits<std::uint16_t>::max()) {
    const std::vector<std::uint16_t> small(values.begin(), values.end());
    return add_accessor(add_view(small.data(), small.size() * 2, GlbUse::kIndices),
                        TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT, TINYGLTF_TYPE_SCALAR, small.size());
  }
  return add_accessor(add_view(values.data(), values.size_bytes(), GlbUse::kIndices),
                      TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT, TINYGLTF_TYPE_SCALAR, values.size());
}

}  // namespace dance
