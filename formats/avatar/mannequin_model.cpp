#include "formats/avatar/mannequin_model.h"

#include "formats/body/body_mesh.h"
#include "formats/body/hand_layout.h"

namespace dance {
namespace {

void add_node(AvatarModel& model, std::string_view name, int parent,
              const Eigen::Vector3f& offset_m) {
  AvatarNode node;
  node.name = name;
  node.parent = parent;
  node.translation_m = offset_m;
  Eigen::Vector3f place_m = offset_m;
  for (int up = parent; up >= 0; up = model.nodes[static_cast<std::size_t>(up)].parent)
    place_m += model.nodes[static_cast<std::size_t>(up)].translation_m;
  AvatarJoint joint;
  joint.node = static_cast<int>(model.nodes.size());
  joint.node_from_mesh = Eigen::Translation3f(-place_m);
  model.nodes.push_back(std::move(node));
  model.joints.push_back(joint);
}

void add_nodes(AvatarModel& model, const Skeleton& skeleton) {
  for (std::size_t b = 0; b < kBoneCount; ++b) {
    model.bones[b] = static_cast<int>(b);
    add_node(model, kBones[b].name, kBones[b].parent, skeleton.offset_m[b]);
  }
  const HandLayout layout = hand_layout(skeleton);
  for (std::size_t f = 0; f < kFingerBoneCount; ++f) {
    const int parent = kFingerBones[f].parent;
    model.fingers[f] = static_cast<int>(kBoneCount + f);
    add_node(model, kFingerBones[f].name,
             parent >= 0 ? static_cast<int>(kBoneCount) + parent
                         : static_cast<int>(index_of(hand_of_finger_bone(f))),
             layout.offset_m[f]);
  }
}

void add_part(AvatarModel& model, const BodyMeshPart& body, const GuestLook& look) {
  const MaterialLook material_look = look_of(body.material, look);
  AvatarMaterial material;
  material.name = material_look.name;
  material.base_colour.head<3>() = material_look.colour;
  material.roughness = material_look.roughness;
  AvatarPart part;
  part.material = static_cast<std::uint32_t>(model.materials.size());
  part.first_index = static_cast<std::uint32_t>(model.triangles.size());
  part.index_count = static_cast<std::uint32_t>(body.triangles.size());
  const auto first = static_cast<std::uint32_t>(model.vertices.size());
  for (std::size_t v = 0; v < body.places_m.size(); ++v) {
    AvatarVertex vertex;
    vertex.place_m = body.places_m[v];
    vertex.normal = body.normals[v];
    vertex.uv.setZero();
    for (std::size_t k = 0; k < 4; ++k) vertex.joints[k] = body.skin[v].joints[k];
    vertex.weights = body.skin[v].weights;
    model.vertices.push_back(vertex);
  }
  for (const std::uint32_t vertex : body.triangles) model.triangles.push_back(first + vertex);
  model.materials.push_back(std::move(material));
  model.parts.push_back(part);
}

}  // namespace

AvatarModel mannequin_model(const Skeleton& skeleton, const GuestLook& look, bool has_fingers) {
  AvatarModel model;
  model.name = "mannequin";
  add_nodes(model, skeleton);
  for (const BodyMeshPart& part : body_mesh(skeleton, look, has_fingers))
    add_part(model, part, look);
  return model;
}

}  // namespace dance
