#include "viewer/mesh/figure_mesh.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_map>

#include "viewer/mesh/detail_levels.h"

namespace dance {
namespace {

using Eigen::Vector3f;

constexpr std::uint32_t kMostMorphsOfAVertex = 255;
constexpr std::uint32_t kMostMorphSteps = 1u << 24;
constexpr std::uint32_t kUnused = std::numeric_limits<std::uint32_t>::max();

std::uint32_t signed_ten_bits(float part) {
  return static_cast<std::uint32_t>(std::lround(std::clamp(part, -1.0f, 1.0f) * 511.0f)) & 0x3ffu;
}
std::uint32_t packed_normal(const Vector3f& normal) {
  const float length = normal.norm();
  const Vector3f n = length > 1e-9f ? Vector3f(normal / length) : Vector3f::UnitY();
  return signed_ten_bits(n.x()) | signed_ten_bits(n.y()) << 10 | signed_ten_bits(n.z()) << 20;
}
std::uint16_t half_of(float value) {
  return Eigen::numext::bit_cast<std::uint16_t>(static_cast<Eigen::half>(value));
}

FigureMaterial packed(const AvatarMaterial& material) {
  FigureMaterial out;
  out.base_colour = material.base_colour;
  const float smooth = 1.0f - std::clamp(material.roughness, 0.0f, 1.0f);
  out.emission_and_gloss << material.emission, smooth * smooth * 1.5f;
  out.shade_colour_and_shift << material.shade_colour, material.shade_shift;
  out.toony_and_cutoff << std::clamp(material.shade_toony, 0.0f, 1.0f), material.alpha_cutoff, 0.0f,
      0.0f;
  return out;
}

// Builds a mesh step by step, in the order of the members' use.
class MeshBuilder {
 public:
  explicit MeshBuilder(const AvatarModel& model) : model_(model) {}

  std::shared_ptr<const FigureMesh> build() {
    find_head();
    gather_morphs();
    for (const AvatarMaterial& material : model_.materials)
      mesh_->materials.push_back(packed(material));
    for (const AvatarPart& part : model_.parts) gather(part);
    add_levels();
    return mesh_;
  }

 private:
  // Joints of the head and of what hangs on it.
  void find_head() {
    const int head = model_.node_of(Bone::kHead);
    std::vector<bool> is_head_node(model_.nodes.size(), false);
    for (std::size_t n = 0; n < model_.nodes.size(); ++n) {
      const int parent = model_.nodes[n].parent;
      is_head_node[n] = static_cast<int>(n) == head ||
                        (parent >= 0 && is_head_node[static_cast<std::size_t>(parent)]);
    }
    for (const AvatarJoint& joint : model_.joints)
      is_head_joint_.push_back(is_head_node[static_cast<std::size_t>(joint.node)]);
  }

  // A morph of all vertices is rare; most move the face. Steps of one vertex lie together.
  void gather_morphs() {
    std::vector<std::vector<MorphStep>> of_vertex(model_.morphs.empty() ? 0
                                                                        : model_.vertices.size());
    moved_m_.assign(model_.vertices.size(), Vector3f::Zero());
    for (std::size_t m = 0; m < model_.morphs.size(); ++m) {
      const AvatarMorph& morph = model_.morphs[m];
      for (std::size_t i = 0; i < morph.vertices.size(); ++i) {
        const Vector3f& place = morph.places_m[i];
        const Vector3f normal = morph.normals.empty() ? Vector3f::Zero() : morph.normals[i];
        if (place.isZero(1e-6f) && normal.isZero(1e-3f)) continue;
        moved_m_[morph.vertices[i]] += place;
        of_vertex[morph.vertices[i]].push_back({half_of(place.x()), half_of(place.y()),
                                                half_of(place.z()), half_of(static_cast<float>(m)),
                                                half_of(normal.x()), half_of(normal.y()),
                                                half_of(normal.z()), 0});
      }
    }
    morphs_of_vertex_.assign(model_.vertices.size(), 0);
    for (std::size_t v = 0; v < of_vertex.size(); ++v) {
      const auto count = std::min<std::size_t>(of_vertex[v].size(), kMostMorphsOfAVertex);
      const std::size_t first = mesh_->morph_steps.size();
      if (count == 0 || first + count > kMostMorphSteps) continue;
      mesh_->morph_steps.insert(mesh_->morph_steps.end(), of_vertex[v].begin(),
                                of_vertex[v].begin() + static_cast<std::ptrdiff_t>(count));
      morphs_of_vertex_[v] = static_cast<std::uint32_t>(first | count << 24);
    }
  }

  // Opaque parts go together wherever they stand; blended ones only with the one before, as their
  // order is what the maker sees.
  std::size_t batch_of(const AvatarPart& part) {
    const AvatarMaterial& material = model_.materials[part.material];
    FigureBatch batch;
    batch.picture = material.picture;
    batch.alpha_mode = material.alpha_mode;
    batch.shading = material.shading;
    batch.is_double_sided = material.is_double_sided;
    if (part.first_person == FirstPerson::kThirdPersonOnly ||
        part.first_person == FirstPerson::kFirstPersonOnly)
      batch.audience = part.first_person;
    batch.material_group = part.material / kMaterialsOfGroup;
    auto& batches = mesh_->batches;
    const bool is_ordered = batch.alpha_mode == AlphaMode::kBlend;
    const auto first = is_ordered && !batches.empty() ? batches.end() - 1 : batches.begin();
    const auto found = std::find(first, batches.end(), batch);
    if (found != batches.end()) return static_cast<std::size_t>(found - batches.begin());
    batches.push_back(batch);
    triangles_.emplace_back();
    return batches.size() - 1;
  }

  void gather(const AvatarPart& part) {
    auto& triangles = triangles_[batch_of(part)];
    // A vertex that two parts use with different materials is there twice.
    std::unordered_map<std::uint32_t, std::uint32_t> packed_as;
    for (std::uint32_t i = 0; i < part.index_count; ++i) {
      const std::uint32_t vertex = model_.triangles[part.first_index + i];
      const auto [found, is_new] =
          packed_as.try_emplace(vertex, static_cast<std::uint32_t>(vertices_.size()));
      if (is_new) add_vertex(vertex, part);
      triangles.push_back(found->second);
    }
  }

  void add_vertex(std::uint32_t index, const AvatarPart& part) {
    const AvatarVertex& from = model_.vertices[index];
    std::array<std::size_t, 4> order{0, 1, 2, 3};
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
      return from.weights[a] > from.weights[b];
    });
    FigureVertex vertex;
    vertex.place_m = {from.place_m.x(), from.place_m.y(), from.place_m.z()};
    vertex.normal = packed_normal(from.normal);
    vertex.uv = {from.uv.x(), from.uv.y()};
    int of_head = 0;
    for (std::size_t k = 0; k < 4; ++k) {
      vertex.joints[k] = from.joints[order[k]];
      vertex.weights[k] = from.weights[order[k]];
      if (is_head_joint_[vertex.joints[k]]) of_head += vertex.weights[k];
    }
    vertex.material = part.material % kMaterialsOfGroup;
    if (part.first_person == FirstPerson::kAuto && of_head > 127)
      vertex.material |= FigureVertex::kOfTheHead;
    vertex.morphs = morphs_of_vertex_[index];
    vertices_.push_back(vertex);
    shapes_.push_back(
        {from.place_m + apart_m(index), from.normal,
         std::min(1.0f, 2.0f * (1.0f - static_cast<float>(vertex.weights[0]) / 255.0f)),
         std::min(1.0f, static_cast<float>(of_head) / 255.0f)});
  }

  // A mouth at rest is one line, so its vertices would be merged. The simplification therefore gets
  // an open, smiling mouth, moved by at most kMost_m.
  Vector3f apart_m(std::uint32_t index) const {
    constexpr float kMost_m = 0.03f;
    const Vector3f& moved_m = moved_m_[index];
    if (!moved_m.allFinite()) return Vector3f::Zero();  // a sum of a hostile file's huge numbers
    const float length_m = moved_m.norm();
    return length_m > kMost_m ? Vector3f(kMost_m / length_m * moved_m) : moved_m;
  }

  // Levels from coarse to fine take their vertices, so that each has the first ones.
  void add_levels() {
    const std::vector<BatchTriangles> levels = detail_levels(shapes_, triangles_);
    std::vector<std::uint32_t> new_index(vertices_.size(), kUnused);
    mesh_->vertices.reserve(vertices_.size());
    mesh_->levels.resize(levels.size());
    for (std::size_t l = levels.size(); l-- > 0;) {
      FigureLevel& level = mesh_->levels[l];
      for (const auto& triangles : levels[l]) {
        level.batches.push_back({static_cast<std::uint32_t>(mesh_->indices.size()),
                                 static_cast<std::uint32_t>(triangles.size())});
        level.triangle_count += static_cast<std::uint32_t>(triangles.size() / 3);
        for (const std::uint32_t vertex : triangles) {
          if (new_index[vertex] == kUnused) {
            new_index[vertex] = static_cast<std::uint32_t>(mesh_->vertices.size());
            mesh_->vertices.push_back(vertices_[vertex]);
          }
          mesh_->indices.push_back(new_index[vertex]);
        }
      }
      level.vertex_count = static_cast<std::uint32_t>(mesh_->vertices.size());
    }
  }

  const AvatarModel& model_;
  std::shared_ptr<FigureMesh> mesh_ = std::make_shared<FigureMesh>();
  std::vector<bool> is_head_joint_;
  std::vector<std::uint32_t> morphs_of_vertex_;
  std::vector<Vector3f> moved_m_;  // of each vertex, by all morphs together
  std::vector<FigureVertex> vertices_;
  std::vector<DetailVertex> shapes_;  // of the same
  BatchTriangles triangles_;          // of each batch
};

}  // namespace

std::shared_ptr<const FigureMesh> figure_mesh(const AvatarModel& model) {
  return MeshBuilder(model).build();
}

std::size_t level_for(const FigureMesh& mesh, double triangles) {
  std::size_t level = 0;
  while (level + 1 < mesh.levels.size() &&
         static_cast<double>(mesh.levels[level + 1].triangle_count) >= triangles)
    ++level;
  return level;
}

}  // namespace dance
