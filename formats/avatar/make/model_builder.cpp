#include "formats/avatar/make/model_builder.h"

#include <algorithm>

#include "formats/body/hand_layout.h"

namespace dance {

using Eigen::Vector3f;

ModelBuilder::ModelBuilder(const Skeleton& skeleton) {
  const auto place_of = [&](int parent, const Vector3f& offset_m) {
    return parent < 0 ? offset_m : Vector3f(place_m(parent) + offset_m);
  };
  for (std::size_t b = 0; b < kBoneCount; ++b)
    model_.bones[b] = add_node(std::string(kBones[b].name), kBones[b].parent,
                               place_of(kBones[b].parent, skeleton.offset_m[b]));
  const HandLayout layout = hand_layout(skeleton);
  for (std::size_t f = 0; f < kFingerBoneCount; ++f) {
    const int above = kFingerBones[f].parent;
    const int parent = above < 0 ? static_cast<int>(index_of(hand_of_finger_bone(f)))
                                 : static_cast<int>(kBoneCount) + above;
    model_.fingers[f] =
        add_node(std::string(kFingerBones[f].name), parent, place_of(parent, layout.offset_m[f]));
  }
}

int ModelBuilder::add_node(const std::string& name, int parent, const Vector3f& place_m) {
  AvatarNode node;
  node.name = name;
  node.parent = parent;
  node.translation_m = parent < 0 ? place_m : Vector3f(place_m - this->place_m(parent));
  AvatarJoint joint;
  joint.node = static_cast<int>(model_.nodes.size());
  joint.node_from_mesh = Eigen::Translation3f(-place_m);
  model_.nodes.push_back(std::move(node));
  model_.joints.push_back(joint);
  places_m_.push_back(place_m);
  return joint.node;
}

int ModelBuilder::add_material(AvatarMaterial material) {
  model_.materials.push_back(std::move(material));
  return static_cast<int>(model_.materials.size()) - 1;
}

int ModelBuilder::add_double_sided(int material) {
  AvatarMaterial copy = model_.materials[static_cast<std::size_t>(material)];
  copy.is_double_sided = true;
  copy.name += "BothSides";
  return add_material(std::move(copy));
}

void ModelBuilder::make_double_sided(int material) {
  model_.materials[static_cast<std::size_t>(material)].is_double_sided = true;
}

int ModelBuilder::add_picture(AvatarPicture picture) {
  model_.pictures.push_back(std::move(picture));
  return static_cast<int>(model_.pictures.size()) - 1;
}

bool ModelBuilder::has_morph(const std::string& name) const {
  return std::ranges::any_of(model_.morphs,
                             [&](const AvatarMorph& morph) { return morph.name == name; });
}

std::uint32_t ModelBuilder::morph(const std::string& name) {
  for (std::uint32_t m = 0; m < model_.morphs.size(); ++m)
    if (model_.morphs[m].name == name) return m;
  AvatarMorph morph;
  morph.name = name;
  model_.morphs.push_back(std::move(morph));
  return static_cast<std::uint32_t>(model_.morphs.size()) - 1;
}

void ModelBuilder::add_sheet(const Sheet& sheet, int material, FirstPerson first_person) {
  if (sheet.triangles.empty()) return;
  constexpr float kSamePlace_m = 1e-5f;
  const auto first = static_cast<std::uint32_t>(model_.vertices.size());
  AvatarPart part;
  part.first_index = static_cast<std::uint32_t>(model_.triangles.size());
  part.index_count = static_cast<std::uint32_t>(sheet.triangles.size());
  part.material = static_cast<std::uint32_t>(material);
  part.first_person = first_person;
  model_.parts.push_back(part);
  model_.vertices.insert(model_.vertices.end(), sheet.vertices.begin(), sheet.vertices.end());
  for (const std::uint32_t vertex : sheet.triangles) model_.triangles.push_back(first + vertex);
  for (const auto& [name, places_m] : sheet.shapes) {
    AvatarMorph& out = model_.morphs[morph(name)];
    for (std::size_t v = 0; v < places_m.size(); ++v) {
      const Vector3f move = places_m[v] - sheet.vertices[v].place_m;
      if (move.norm() < kSamePlace_m) continue;
      out.vertices.push_back(first + static_cast<std::uint32_t>(v));
      out.places_m.push_back(move);
    }
  }
}

std::uint32_t ModelBuilder::add_collider(Bone bone, const Vector3f& a_m, const Vector3f& b_m,
                                         float radius_m) {
  AvatarCollider collider;
  collider.node = static_cast<int>(index_of(bone));
  collider.centre_m = a_m - place_m(collider.node);
  collider.tail_m = b_m - place_m(collider.node);
  collider.radius_m = radius_m;
  model_.colliders.push_back(collider);
  return static_cast<std::uint32_t>(model_.colliders.size()) - 1;
}

void ModelBuilder::add_spring(const std::vector<int>& chain, const Swing& swing,
                              std::vector<std::uint32_t> colliders) {
  AvatarSpring spring;
  for (std::size_t i = 0; i + 1 < chain.size(); ++i) {
    AvatarSpring::Joint joint;
    joint.node = chain[i];
    joint.tail_m = place_m(chain[i + 1]) - place_m(chain[i]);
    joint.radius_m = swing.radius_m;
    joint.stiffness = swing.stiffness;
    joint.gravity = swing.gravity;
    joint.drag = swing.drag;
    spring.joints.push_back(joint);
  }
  spring.colliders = std::move(colliders);
  model_.springs.push_back(std::move(spring));
}

void ModelBuilder::add_expression(const std::string& name, const std::vector<std::string>& morphs) {
  AvatarExpression expression;
  expression.name = name;
  for (const std::string& of : morphs) expression.binds.push_back({morph(of), 1.0f});
  model_.expressions.push_back(std::move(expression));
}

AvatarModel ModelBuilder::take(const std::string& name, const std::string& licence) {
  model_.name = name;
  model_.licence = licence;
  for (const char* word : {"happy", "angry", "sad", "relaxed", "surprised", "aa", "ih", "ou", "ee",
                           "oh", "blinkLeft", "blinkRight"})
    if (has_morph(word)) add_expression(word, {word});
  if (has_morph("blinkLeft")) add_expression("blink", {"blinkLeft", "blinkRight"});
  return std::move(model_);
}

}  // namespace dance
