#include "formats/avatar/avatar_model.h"

#include <algorithm>

namespace dance {
namespace {

template <class Items>
bool holds(const Items& items, int index) {
  return index >= 0 && static_cast<std::size_t>(index) < items.size();
}

bool is_sound_node(const AvatarModel& model, std::size_t i) {
  const AvatarNode& node = model.nodes[i];
  return node.parent >= -1 && node.parent < static_cast<int>(i) && node.translation_m.allFinite() &&
         node.scale.allFinite() && node.rotation.coeffs().allFinite() &&
         std::abs(node.rotation.squaredNorm() - 1.0f) < 1e-3f;
}

bool is_sound_vertex(const AvatarModel& model, const AvatarVertex& vertex) {
  int sum = 0;
  for (const std::uint8_t weight : vertex.weights) sum += weight;
  return sum == 255 && vertex.place_m.allFinite() && vertex.normal.allFinite() &&
         vertex.uv.allFinite() &&
         std::ranges::all_of(vertex.joints, [&](auto j) { return j < model.joints.size(); });
}

bool is_sound_part(const AvatarModel& model, const AvatarPart& part) {
  return part.index_count % 3 == 0 && part.first_index <= model.triangles.size() &&
         part.index_count <= model.triangles.size() - part.first_index &&
         part.material < model.materials.size();
}

bool is_sound_material(const AvatarModel& model, const AvatarMaterial& material) {
  return material.base_colour.allFinite() && material.emission.allFinite() &&
         material.shade_colour.allFinite() && std::isfinite(material.alpha_cutoff) &&
         std::isfinite(material.roughness) && std::isfinite(material.shade_shift) &&
         std::isfinite(material.shade_toony) &&
         (material.picture == -1 || holds(model.pictures, material.picture));
}

bool is_sound_picture(const AvatarPicture& picture) {
  return picture.width_px > 0 && picture.height_px > 0 &&
         picture.rgba.size() == std::size_t{4} * static_cast<std::size_t>(picture.width_px) *
                                    static_cast<std::size_t>(picture.height_px);
}

bool is_sound_morph(const AvatarModel& model, const AvatarMorph& morph) {
  const auto is_finite = [](const Eigen::Vector3f& v) { return v.allFinite(); };
  return morph.places_m.size() == morph.vertices.size() &&
         (morph.normals.empty() || morph.normals.size() == morph.vertices.size()) &&
         std::ranges::all_of(morph.vertices,
                             [&](auto vertex) { return vertex < model.vertices.size(); }) &&
         std::ranges::all_of(morph.places_m, is_finite) &&
         std::ranges::all_of(morph.normals, is_finite);
}

bool is_sound_spring(const AvatarModel& model, const AvatarSpring& spring) {
  return (spring.centre == -1 || holds(model.nodes, spring.centre)) &&
         std::ranges::all_of(spring.colliders,
                             [&](auto c) { return c < model.colliders.size(); }) &&
         std::ranges::all_of(spring.joints, [&](const AvatarSpring::Joint& joint) {
           return holds(model.nodes, joint.node) && joint.tail_m.allFinite() &&
                  joint.gravity_direction.allFinite() && std::isfinite(joint.radius_m) &&
                  std::isfinite(joint.stiffness) && std::isfinite(joint.gravity) &&
                  std::isfinite(joint.drag);
         });
}

template <std::size_t kCount>
bool are_nodes(const AvatarModel& model, const std::array<int, kCount>& nodes) {
  return std::ranges::all_of(nodes, [&](int n) { return n == -1 || holds(model.nodes, n); });
}

}  // namespace

bool is_sound(const AvatarModel& model) {
  for (std::size_t i = 0; i < model.nodes.size(); ++i)
    if (!is_sound_node(model, i)) return false;
  return are_nodes(model, model.bones) && are_nodes(model, model.fingers) &&
         are_nodes(model, model.eyes) &&
         std::ranges::all_of(kNeededBones, [&](Bone b) { return model.node_of(b) >= 0; }) &&
         std::ranges::all_of(model.joints,
                             [&](const AvatarJoint& joint) {
                               return holds(model.nodes, joint.node) &&
                                      joint.node_from_mesh.matrix().allFinite();
                             }) &&
         std::ranges::all_of(model.vertices,
                             [&](const auto& vertex) { return is_sound_vertex(model, vertex); }) &&
         std::ranges::all_of(model.triangles, [&](auto v) { return v < model.vertices.size(); }) &&
         std::ranges::all_of(model.parts,
                             [&](const auto& part) { return is_sound_part(model, part); }) &&
         std::ranges::all_of(model.materials,
                             [&](const auto& it) { return is_sound_material(model, it); }) &&
         std::ranges::all_of(model.pictures, is_sound_picture) &&
         std::ranges::all_of(model.morphs,
                             [&](const auto& morph) { return is_sound_morph(model, morph); }) &&
         std::ranges::all_of(model.expressions,
                             [&](const AvatarExpression& expression) {
                               return std::ranges::all_of(expression.binds, [&](const auto& bind) {
                                 return bind.morph < model.morphs.size() &&
                                        std::isfinite(bind.weight);
                               });
                             }) &&
         std::ranges::all_of(model.springs,
                             [&](const auto& spring) { return is_sound_spring(model, spring); }) &&
         std::ranges::all_of(model.colliders, [&](const AvatarCollider& it) {
           return holds(model.nodes, it.node) && it.centre_m.allFinite() && it.tail_m.allFinite() &&
                  std::isfinite(it.radius_m);
         });
}

}  // namespace dance
