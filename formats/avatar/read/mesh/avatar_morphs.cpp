#include "formats/avatar/read/mesh/avatar_morphs.h"

#include <algorithm>

#include "formats/gltf/glb_accessor.h"
#include "formats/gltf/glb_json.h"
#include "formats/gltf/glb_text.h"

namespace dance {
namespace {

// Less than this does not move a vertex. (Quantised meshes count in larger units.)
constexpr float kMoves_m = 1e-6f;
constexpr std::size_t kMoveBytes = sizeof(std::uint32_t) + 2 * sizeof(Eigen::Vector3f);

std::string name_of(const tinygltf::Mesh& mesh, std::size_t target) {
  const std::string_view named = text_in(item(member(&mesh.extras, "targetNames"), target));
  if (!named.empty()) return plain_name(named);
  if (!mesh.primitives.empty()) {
    const tinygltf::Value& extras = mesh.primitives.front().extras;
    const std::string_view told = text_in(item(member(&extras, "targetNames"), target));
    if (!told.empty()) return plain_name(told);
  }
  return plain_name(mesh.name) + "." + std::to_string(target);
}

Result<std::vector<float>> read_moves(AvatarSource& source,
                                      const std::map<std::string, int>& target, const char* what,
                                      std::uint32_t count) {
  const auto found = target.find(what);
  if (found == target.end()) return std::vector<float>{};
  if (element_count(source.file, found->second) != count)
    return fail("a morph target is not as long as its mesh has vertices");
  const std::size_t numbers = std::size_t{3} * count;
  if (numbers > source.numbers_left)
    return fail("its morph targets hold more numbers than an avatar may; export fewer of them");
  source.numbers_left -= numbers;
  return read_attribute(source.file, found->second, 3, numbers);
}

Eigen::Vector3f at(const std::vector<float>& values, std::size_t v) {
  if (values.empty()) return Eigen::Vector3f::Zero();
  return {values[3 * v], values[3 * v + 1], values[3 * v + 2]};
}

}  // namespace

Result<MeshMorphs> begin_morphs(AvatarSource& source, int node, int index) {
  const tinygltf::Mesh& mesh = source.file.meshes[static_cast<std::size_t>(index)];
  std::size_t targets = 0;
  for (const tinygltf::Primitive& primitive : mesh.primitives)
    targets = std::max(targets, primitive.targets.size());
  auto& morphs = source.model.morphs;
  if (targets > source.limits.morphs - morphs.size())
    return fail("more than " + std::to_string(source.limits.morphs) +
                " morph targets; export fewer of them");
  MeshMorphs of_mesh{node, index, static_cast<std::uint32_t>(morphs.size()),
                     static_cast<std::uint32_t>(targets)};
  for (std::size_t t = 0; t < targets; ++t) {
    morphs.emplace_back();
    morphs.back().name = name_of(mesh, t);
  }
  return of_mesh;
}

Result<void> read_targets(AvatarSource& source, const tinygltf::Primitive& primitive,
                          std::uint32_t first, std::uint32_t count, const MeshMorphs& morphs) {
  for (std::size_t t = 0; t < primitive.targets.size(); ++t) {
    DANCE_TRY(const auto places, read_moves(source, primitive.targets[t], "POSITION", count));
    DANCE_TRY(const auto normals, read_moves(source, primitive.targets[t], "NORMAL", count));
    AvatarMorph& morph = source.model.morphs[morphs.first + t];
    const std::size_t before = morph.vertices.size();
    for (std::uint32_t v = 0; v < count && !places.empty(); ++v) {
      const Eigen::Vector3f move = at(places, v);
      const Eigen::Vector3f turn = at(normals, v);
      if (move.cwiseAbs().maxCoeff() < kMoves_m && turn.cwiseAbs().maxCoeff() < 1e-3f) continue;
      morph.vertices.push_back(first + v);
      morph.places_m.push_back(move);
      // Another primitive of the mesh may have none: all or none of a morph's have normals.
      if (!normals.empty() && morph.normals.empty())
        morph.normals.assign(morph.vertices.size() - 1, Eigen::Vector3f::Zero());
      if (!normals.empty() || !morph.normals.empty()) morph.normals.push_back(turn);
    }
    const std::size_t moved = morph.vertices.size() - before;
    if (moved > source.morph_moves_left)
      return fail("its morph targets move too many vertices; export fewer of them");
    source.morph_moves_left -= moved;
    if (auto taken = source.take_bytes(moved * kMoveBytes); !taken) return taken;
  }
  return {};
}

}  // namespace dance
