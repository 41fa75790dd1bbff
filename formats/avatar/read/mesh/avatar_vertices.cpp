#include "formats/avatar/read/mesh/avatar_vertices.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "formats/gltf/glb_accessor.h"

namespace dance {
namespace {

constexpr float kLargestUv = 1e6f;
constexpr std::size_t kMostInfluences = 8;

int accessor_of(const tinygltf::Primitive& primitive, const std::string& attribute) {
  const auto found = primitive.attributes.find(attribute);
  return found != primitive.attributes.end() ? found->second : -1;
}

// One for each vertex, or an error.
Result<std::vector<float>> read_for_each(AvatarSource& source, int accessor, std::size_t components,
                                         std::size_t vertices) {
  if (element_count(source.file, accessor) != vertices)
    return fail("accessor " + std::to_string(accessor) +
                " is not as long as its vertices are many");
  if (vertices * components > source.numbers_left)
    return fail("its meshes hold more numbers than an avatar may; export a simpler mesh");
  source.numbers_left -= vertices * components;
  return read_attribute(source.file, accessor, components, vertices * components);
}

Result<void> read_normals(AvatarSource& source, const tinygltf::Primitive& primitive,
                          VertexBlock& block) {
  const int accessor = accessor_of(primitive, "NORMAL");
  if (accessor < 0) return {};
  DANCE_TRY(const auto normals, read_for_each(source, accessor, 3, block.vertices.size()));
  for (std::size_t v = 0; v < block.vertices.size(); ++v) {
    const Eigen::Vector3f normal(normals[3 * v], normals[3 * v + 1], normals[3 * v + 2]);
    const float length = normal.stableNorm();
    block.vertices[v].normal = length > 1e-6f && std::isfinite(length) ? (normal / length).eval()
                                                                       : Eigen::Vector3f::UnitY();
  }
  block.has_normals = true;
  return {};
}

Result<void> read_uv(AvatarSource& source, const tinygltf::Primitive& primitive,
                     const MaterialUv& uv, VertexBlock& block) {
  const int accessor = accessor_of(primitive, "TEXCOORD_" + std::to_string(uv.set));
  if (accessor < 0) return {};
  DANCE_TRY(const auto values, read_for_each(source, accessor, 2, block.vertices.size()));
  for (std::size_t v = 0; v < block.vertices.size(); ++v) {
    const Eigen::Vector2f placed =
        uv.turn * Eigen::Vector2f(values[2 * v], values[2 * v + 1]) + uv.offset;
    if (placed.allFinite())
      block.vertices[v].uv = placed.cwiseMax(-kLargestUv).cwiseMin(kLargestUv);
  }
  return {};
}

// The influences of all vertices, four or eight each.
struct Influences {
  std::size_t per_vertex = 0;
  std::vector<std::uint32_t> joints;
  std::vector<float> weights;
};

Result<Influences> read_influences(AvatarSource& source, const tinygltf::Primitive& primitive,
                                   std::size_t vertices) {
  Influences all;
  std::array<std::vector<std::uint32_t>, 2> joints;
  std::array<std::vector<float>, 2> weights;
  std::size_t sets = 0;
  for (; sets < 2; ++sets) {
    const int joints_accessor = accessor_of(primitive, "JOINTS_" + std::to_string(sets));
    const int weights_accessor = accessor_of(primitive, "WEIGHTS_" + std::to_string(sets));
    if (joints_accessor < 0 || weights_accessor < 0) break;
    if (element_count(source.file, joints_accessor) != vertices)
      return fail("the joints of a mesh are not as many as its vertices");
    DANCE_TRY(joints[sets], read_integers(source.file, joints_accessor, 4, 4 * vertices));
    DANCE_TRY(weights[sets], read_for_each(source, weights_accessor, 4, vertices));
  }
  all.per_vertex = 4 * sets;
  for (std::size_t v = 0; v < vertices; ++v)
    for (std::size_t set = 0; set < sets; ++set)
      for (std::size_t k = 0; k < 4; ++k) {
        all.joints.push_back(joints[set][4 * v + k]);
        all.weights.push_back(weights[set][4 * v + k]);
      }
  return all;
}

Result<void> tie(AvatarSource& source, const tinygltf::Primitive& primitive,
                 const std::vector<std::uint16_t>& joints, VertexBlock& block) {
  DANCE_TRY(const Influences all, read_influences(source, primitive, block.vertices.size()));
  const std::size_t count = all.per_vertex;
  for (std::size_t v = 0; v < block.vertices.size(); ++v) {
    std::array<std::uint16_t, kMostInfluences> of_model{};
    for (std::size_t k = 0; k < count; ++k) {
      const std::uint32_t joint = all.joints[v * count + k];
      // Exporters leave anything where the weight is 0.
      if (joint >= joints.size() && all.weights[v * count + k] > 0.0f)
        return fail("a vertex follows a joint that its skin does not have");
      of_model[k] = joints[joint < joints.size() ? joint : 0];
    }
    const FourWeights four = four_largest(std::span(of_model).first(count),
                                          std::span(all.weights).subspan(v * count, count));
    block.vertices[v].joints = four.joints;
    block.vertices[v].weights = four.weights;
  }
  return {};
}

}  // namespace

FourWeights four_largest(std::span<const std::uint16_t> joints, std::span<const float> weights) {
  std::array<std::size_t, kMostInfluences> order{};
  const std::size_t count = std::min(joints.size(), kMostInfluences);
  for (std::size_t k = 0; k < count; ++k) order[k] = k;
  std::stable_sort(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(count),
                   [&](std::size_t a, std::size_t b) { return weights[a] > weights[b]; });
  FourWeights four;
  if (count == 0) return four;
  const std::size_t kept = std::min<std::size_t>(count, 4);
  double sum = 0.0;
  for (std::size_t k = 0; k < kept; ++k) sum += std::max(0.0f, weights[order[k]]);
  four.joints.fill(joints[order[0]]);
  if (!(sum > 0.0) || !std::isfinite(sum)) return four;
  int left = 255;
  for (std::size_t k = kept; k-- > 1;) {
    const double part = std::max(0.0f, weights[order[k]]) / sum;
    four.weights[k] = static_cast<std::uint8_t>(std::lround(255.0 * part));
    if (four.weights[k] > 0) four.joints[k] = joints[order[k]];
    left -= four.weights[k];
  }
  // The largest is at least a quarter: what rounding leaves is its.
  four.weights[0] = static_cast<std::uint8_t>(left);
  return four;
}

Result<VertexBlock> read_vertices(AvatarSource& source, const tinygltf::Primitive& primitive,
                                  const MaterialUv& uv, const std::vector<std::uint16_t>& joints,
                                  bool is_skinned, std::size_t most) {
  const int accessor = accessor_of(primitive, "POSITION");
  const std::size_t count = element_count(source.file, accessor);
  if (count == 0) return fail("a mesh without places of its vertices");
  if (count > most)
    return fail("more than " + std::to_string(source.limits.vertices) +
                " vertices; export a simpler mesh");
  DANCE_TRY(const auto places, read_for_each(source, accessor, 3, count));
  if (auto taken = source.take_bytes(count * sizeof(AvatarVertex)); !taken)
    return tl::make_unexpected(taken.error());
  AvatarVertex vertex;
  vertex.normal.setZero();
  vertex.uv.setZero();
  vertex.joints.fill(joints.front());
  VertexBlock block;
  block.vertices.reserve(count);
  for (std::size_t v = 0; v < count; ++v) {
    vertex.place_m = {places[3 * v], places[3 * v + 1], places[3 * v + 2]};
    block.vertices.push_back(vertex);
  }
  if (auto done = read_normals(source, primitive, block); !done)
    return tl::make_unexpected(done.error());
  if (auto done = read_uv(source, primitive, uv, block); !done)
    return tl::make_unexpected(done.error());
  if (is_skinned)
    if (auto done = tie(source, primitive, joints, block); !done)
      return tl::make_unexpected(done.error());
  return block;
}

}  // namespace dance
