#include "formats/avatar/read/mesh/avatar_meshes.h"

#include <algorithm>
#include <array>
#include <compare>
#include <map>
#include <optional>

#include "formats/avatar/read/avatar_first_person.h"
#include "formats/avatar/read/avatar_nodes.h"
#include "formats/avatar/read/mesh/avatar_joints.h"
#include "formats/avatar/read/mesh/avatar_morphs.h"
#include "formats/avatar/read/mesh/avatar_triangles.h"
#include "formats/avatar/read/mesh/avatar_vertices.h"

namespace dance {
namespace {

// Primitives often share their vertices: one block of the model's serves them all.
struct BlockKey {
  int node = -1;
  std::map<std::string, int> attributes;
  std::vector<std::map<std::string, int>> targets;
  int uv_set = 0;
  std::array<float, 6> uv_placed{};

  auto operator<=>(const BlockKey&) const = default;
};

struct Block {
  std::uint32_t first = 0;
  std::uint32_t count = 0;
  bool has_normals = false;
};

struct PartTriangles {
  std::uint32_t material = 0;
  FirstPerson first_person = FirstPerson::kAuto;
  std::vector<std::uint32_t> triangles;
};

class MeshReader {
 public:
  MeshReader(AvatarSource& source, std::vector<MaterialUv> uvs)
      : source_(source),
        uvs_(std::move(uvs)),
        joints_(source),
        first_person_(source.file),
        triangles_left_(source.limits.triangles),
        rest_(rest_transforms(source.model)),
        is_of_figure_(nodes_of_figure()),
        skin_follows_(source.file.skins.size()) {}

  Result<ReadMeshes> read() {
    const std::vector<bool> is_shown = shown_nodes();
    for (const int node : source_.scene.parents_first) {
      const tinygltf::Node& from = source_.file.nodes[static_cast<std::size_t>(node)];
      if (from.mesh < 0 || !is_shown[static_cast<std::size_t>(node)]) continue;
      if (static_cast<std::size_t>(from.mesh) >= source_.file.meshes.size())
        return fail("node " + std::to_string(node) + " has a mesh that is not in the file");
      DANCE_TRY(const bool follows, follows_figure(node, from));
      if (!follows) {
        source_.note("meshes that do not hang from the figure are left out");
        continue;
      }
      if (auto done = read_mesh(node, from); !done) return tl::make_unexpected(done.error());
    }
    make_normals();
    put_parts();
    return std::move(out_);
  }

 private:
  // Those of the file's scene, or all where it tells none.
  std::vector<bool> shown_nodes() const {
    const auto& scenes = source_.file.scenes;
    const int chosen = std::max(0, source_.file.defaultScene);
    if (static_cast<std::size_t>(chosen) >= scenes.size())
      return std::vector<bool>(source_.scene.nodes.size(), true);
    std::vector<bool> is_shown(source_.scene.nodes.size(), false);
    for (const int root : scenes[static_cast<std::size_t>(chosen)].nodes)
      if (root >= 0 && static_cast<std::size_t>(root) < is_shown.size())
        is_shown[static_cast<std::size_t>(root)] = true;
    for (const int node : source_.scene.parents_first) {
      const int parent = source_.scene.at(node).parent;
      if (parent >= 0 && is_shown[static_cast<std::size_t>(parent)])
        is_shown[static_cast<std::size_t>(node)] = true;
    }
    return is_shown;
  }

  // Of the model's nodes, those at and below the hips.
  std::vector<bool> nodes_of_figure() const {
    const AvatarModel& model = source_.model;
    std::vector<bool> is_of_figure(model.nodes.size(), false);
    for (std::size_t n = 0; n < model.nodes.size(); ++n) {  // parents first
      const int parent = model.nodes[n].parent;
      is_of_figure[n] = static_cast<int>(n) == model.node_of(Bone::kHips) ||
                        (parent >= 0 && is_of_figure[static_cast<std::size_t>(parent)]);
    }
    return is_of_figure;
  }

  bool is_of_figure(int file_node) const {
    return file_node >= 0 && static_cast<std::size_t>(file_node) < source_.scene.nodes.size() &&
           is_of_figure_[static_cast<std::size_t>(source_.model_node(file_node))];
  }

  Result<bool> follows_figure(int node, const tinygltf::Node& from) {
    if (from.skin < 0 || static_cast<std::size_t>(from.skin) >= source_.file.skins.size())
      return is_of_figure(node);
    const auto skin = static_cast<std::size_t>(from.skin);
    // Many nodes may share a skin.
    if (skin_follows_[skin]) return *skin_follows_[skin];
    const auto& joints = source_.file.skins[skin].joints;
    if (auto fits = joints_.check_count(from.skin); !fits) return tl::make_unexpected(fits.error());
    if (auto done = source_.look_at(joints.size()); !done) return tl::make_unexpected(done.error());
    skin_follows_[skin] =
        std::any_of(joints.begin(), joints.end(), [&](int j) { return is_of_figure(j); });
    return *skin_follows_[skin];
  }

  // What a primitive costs even where its vertices and triangles are known.
  static std::size_t things_in(const tinygltf::Primitive& primitive) {
    std::size_t things = 1 + primitive.attributes.size() + primitive.targets.size();
    for (const auto& target : primitive.targets) things += target.size();
    return things;
  }

  Result<void> read_mesh(int node, const tinygltf::Node& from) {
    const tinygltf::Mesh& mesh = source_.file.meshes[static_cast<std::size_t>(from.mesh)];
    if (auto done = source_.look_at(1 + mesh.primitives.size()); !done) return done;
    DANCE_TRY(const MeshMorphs morphs, begin_morphs(source_, node, from.mesh));
    if (morphs.count > 0) out_.morphs.push_back(morphs);
    for (const tinygltf::Primitive& primitive : mesh.primitives) {
      if (auto done = source_.look_at(things_in(primitive)); !done) return done;
      DANCE_TRY(const std::uint32_t material, material_of(primitive));
      DANCE_TRY(const Block block, block_of(node, from, primitive, material, morphs));
      DANCE_TRY(auto triangles, read_triangles(source_, primitive, block.count, triangles_left_));
      if (from.skin < 0 && is_mirrored(node)) turn_over(triangles);
      if (triangles.empty()) continue;
      DANCE_TRY(PartTriangles * part, part_of(material, first_person_.of(node, from.mesh)));
      for (const std::uint32_t vertex : triangles) part->triangles.push_back(block.first + vertex);
    }
    return {};
  }

  Result<std::uint32_t> material_of(const tinygltf::Primitive& primitive) {
    const auto count = source_.file.materials.size();
    if (primitive.material >= 0 && static_cast<std::size_t>(primitive.material) >= count)
      return fail("a mesh has a material that is not in the file");
    if (primitive.material >= 0) return static_cast<std::uint32_t>(primitive.material);
    if (source_.model.materials.size() == count) {
      source_.model.materials.emplace_back();
      uvs_.emplace_back();
    }
    return static_cast<std::uint32_t>(count);
  }

  Result<Block> block_of(int node, const tinygltf::Node& from, const tinygltf::Primitive& primitive,
                         std::uint32_t material, const MeshMorphs& morphs) {
    Block block;
    const MaterialUv& uv = uvs_[material];
    const BlockKey key{
        node,
        primitive.attributes,
        primitive.targets,
        uv.set,
        {uv.turn(0, 0), uv.turn(0, 1), uv.turn(1, 0), uv.turn(1, 1), uv.offset.x(), uv.offset.y()}};
    if (const auto known = blocks_.find(key); known != blocks_.end()) return known->second;
    const bool is_skinned = from.skin >= 0 && primitive.attributes.contains("JOINTS_0");
    std::vector<std::uint16_t> of_node;
    const std::vector<std::uint16_t>* joints = &of_node;
    if (is_skinned) {
      DANCE_TRY(joints, joints_.of_skin(from.skin));
    } else {
      DANCE_TRY(const std::uint16_t joint, joints_.of_node(node));
      of_node.push_back(joint);
    }
    auto& vertices = source_.model.vertices;
    DANCE_TRY(const VertexBlock read, read_vertices(source_, primitive, uv, *joints, is_skinned,
                                                    source_.limits.vertices - vertices.size()));
    block.first = static_cast<std::uint32_t>(vertices.size());
    block.count = static_cast<std::uint32_t>(read.vertices.size());
    block.has_normals = read.has_normals;
    vertices.insert(vertices.end(), read.vertices.begin(), read.vertices.end());
    if (auto done = read_targets(source_, primitive, block.first, block.count, morphs); !done)
      return tl::make_unexpected(done.error());
    blocks_.emplace(key, block);
    return block;
  }

  bool is_mirrored(int node) const {
    return rest_[static_cast<std::size_t>(source_.model_node(node))].linear().determinant() < 0.0;
  }

  static void turn_over(std::vector<std::uint32_t>& triangles) {
    for (std::size_t i = 2; i < triangles.size(); i += 3) std::swap(triangles[i - 1], triangles[i]);
  }

  Result<PartTriangles*> part_of(std::uint32_t material, FirstPerson first_person) {
    for (PartTriangles& part : parts_)
      if (part.material == material && part.first_person == first_person) return &part;
    if (parts_.size() >= source_.limits.parts)
      return fail("more than " + std::to_string(source_.limits.parts) +
                  " parts; join meshes and materials");
    parts_.push_back({material, first_person, {}});
    return &parts_.back();
  }

  // Of vertices that have none: the mean of their triangles', larger ones counting more.
  void make_normals() {
    auto& vertices = source_.model.vertices;
    std::vector<bool> lacks(vertices.size(), false);
    for (const auto& [key, block] : blocks_)
      if (!block.has_normals) std::fill_n(lacks.begin() + block.first, block.count, true);
    for (const PartTriangles& part : parts_)
      for (std::size_t i = 2; i < part.triangles.size(); i += 3) {
        if (!lacks[part.triangles[i]]) continue;
        const auto place = [&](std::size_t corner) {
          return vertices[part.triangles[i - corner]].place_m;
        };
        const Eigen::Vector3f normal = (place(1) - place(2)).cross(place(0) - place(2));
        if (!normal.allFinite()) continue;
        for (std::size_t corner = 0; corner < 3; ++corner)
          vertices[part.triangles[i - corner]].normal += normal;
      }
    for (std::size_t v = 0; v < vertices.size(); ++v) {
      if (!lacks[v]) continue;
      const float length = vertices[v].normal.stableNorm();
      vertices[v].normal = length > 0.0f && std::isfinite(length)
                               ? (vertices[v].normal / length).eval()
                               : Eigen::Vector3f::UnitY();
    }
  }

  void put_parts() {
    AvatarModel& model = source_.model;
    for (const PartTriangles& from : parts_) {
      AvatarPart part;
      part.first_index = static_cast<std::uint32_t>(model.triangles.size());
      part.index_count = static_cast<std::uint32_t>(from.triangles.size());
      part.material = from.material;
      part.first_person = from.first_person;
      model.triangles.insert(model.triangles.end(), from.triangles.begin(), from.triangles.end());
      model.parts.push_back(part);
    }
  }

  AvatarSource& source_;
  std::vector<MaterialUv> uvs_;
  AvatarJoints joints_;
  const AvatarFirstPerson first_person_;
  std::size_t triangles_left_;
  const std::vector<Eigen::Affine3d> rest_;
  const std::vector<bool> is_of_figure_;
  std::vector<std::optional<bool>> skin_follows_;  // once it has been looked at
  std::map<BlockKey, Block> blocks_;
  std::vector<PartTriangles> parts_;
  ReadMeshes out_;
};

}  // namespace

Result<ReadMeshes> read_meshes(AvatarSource& source, std::vector<MaterialUv> uvs) {
  return MeshReader(source, std::move(uvs)).read();
}

}  // namespace dance
