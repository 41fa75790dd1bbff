#include "formats/avatar/make/mannequin_head.h"

#include <algorithm>
#include <array>
#include <string_view>

#include "formats/avatar/make/face/face_maker.h"
#include "formats/avatar/make/face/hair_maker.h"
#include "formats/body/body_mesh.h"
#include "formats/body/implicit_surface.h"
#include "formats/body/skin_weights.h"

namespace dance {
namespace {

using Eigen::Vector3f;

// The only expressions of a mannequin: each shape costs time at every vertex that it moves.
constexpr std::array<std::string_view, 8> kShapes{"aa", "ee", "happy",     "ih",
                                                  "oh", "ou", "blinkLeft", "blinkRight"};
constexpr float kIris_deg = 31.0f, kPupil_deg = 13.0f, kWhite_deg = 84.0f;
constexpr std::array<std::uint32_t, 4> kEyeColours{0x5a3a22, 0x3f2a1a, 0x4a6a48, 0x4d7391};

FaceShape shape_of(const GuestLook& look) {
  return look.hair_style == Hair::kShort ? FaceShape::kStrong : FaceShape::kSoft;
}

// Light eyes go with light hair and light skin, brown eyes with all others.
Vector3f eye_colour(const GuestLook& look) {
  constexpr float kLight = 0.12f;
  const bool is_light = look.hair.x() > kLight && look.skin.x() > 0.4f;
  const bool is_second = look.shoes.x() > look.shoes.z();
  return linear_from_srgb(kEyeColours[(is_light ? 2u : 0u) + (is_second ? 1u : 0u)]);
}

AvatarMaterial material_of(const char* name, const Vector3f& colour, float roughness) {
  AvatarMaterial material;
  material.name = name;
  material.base_colour.head<3>() = colour;
  material.roughness = roughness;
  return material;
}

FigureLayer hair_of(const FaceSurface& face, Hair style) {
  FigureLayer hair = hair_layer(face, style);
  hair.cell_m = face.scale() * 0.011f;
  if (style != Hair::kPonytail) return hair;
  const auto add = [&](const Vector3f& a_m, float radius_a_m, const Vector3f& b_m,
                       float radius_b_m) {
    FigurePart part;
    part.a_m = face.at(a_m);
    part.b_m = face.at(b_m);
    part.radius_a_m = face.scale() * radius_a_m;
    part.radius_b_m = face.scale() * radius_b_m;
    hair.parts.push_back(part);
  };
  add({0, 0.15f, -0.115f}, 0.027f, {0, 0.075f, -0.155f}, 0.039f);
  add({0, 0.075f, -0.155f}, 0.039f, {0, -0.05f, -0.163f}, 0.011f);
  return hair;
}

Sheet with_shapes(Sheet sheet) {
  std::erase_if(sheet.shapes, [](const auto& shape) {
    return std::ranges::find(kShapes, shape.first) == kShapes.end();
  });
  return sheet;
}

Sheet build_sheet(const FigureLayer& layer, const SkinWeighting& weighting) {
  const Surface surface = surface_of(layer);
  Sheet sheet;
  sheet.triangles = surface.triangles;
  for (std::size_t v = 0; v < surface.places_m.size(); ++v) {
    AvatarVertex vertex = vertex_at(surface.places_m[v]);
    vertex.normal = surface.normals[v];
    const SkinWeights skin = weighting.weights_at(surface.places_m[v], layer);
    for (std::size_t k = 0; k < 4; ++k) vertex.joints[k] = skin.joints[k];
    vertex.weights = skin.weights;
    sheet.vertices.push_back(vertex);
  }
  return sheet;
}

}  // namespace

void add_mannequin_head(const Skeleton& skeleton, const GuestLook& look, int skin, int hair,
                        ModelBuilder& builder) {
  AvatarDesign design;
  design.look = look;
  design.face = shape_of(look);
  const FaceSurface face(TposePlaces(skeleton), design);
  const FaceMaker features(face, design);
  const SkinWeighting weighting(skeleton);
  std::array<int, 2> eyes{};
  for (std::size_t eye = 0; eye < 2; ++eye)
    eyes[eye] =
        builder.add_node(eye == 0 ? "leftEye" : "rightEye", kHeadJoint, features.eye_m(eye));
  builder.set_eyes(eyes[0], eyes[1]);

  FigureLayer skull = face.layer();
  skull.cell_m = face.scale() * 0.0085f;
  Sheet head = build_sheet(skull, weighting);
  features.add_jaw(head);
  add_to(head, features.lids());
  builder.add_sheet(with_shapes(std::move(head)), skin);
  Sheet dark = build_sheet(hair_of(face, look.hair_style), weighting);
  add_to(dark, features.brows());
  builder.add_sheet(with_shapes(std::move(dark)), hair);

  const auto add = [&](const Sheet& sheet, const AvatarMaterial& material) {
    builder.add_sheet(with_shapes(sheet), builder.add_material(material));
  };
  const MaterialLook white = look_of(Material::kEyeWhite, look);
  const MaterialLook lips = look_of(Material::kLips, look);
  add(features.eye_rings(eyes, kWhite_deg, kIris_deg, 4),
      material_of("eyes", white.colour, white.roughness));
  add(features.eye_rings(eyes, kIris_deg, kPupil_deg, 1),
      material_of("irises", eye_colour(look), 0.3f));
  add(features.eye_rings(eyes, kPupil_deg, 0.0f, 1),
      material_of("pupils", Vector3f::Constant(0.008f), 0.2f));
  AvatarMaterial light = material_of("lights", Vector3f::Constant(0.9f), 0.5f);
  light.emission.setConstant(0.35f);
  add(features.eye_lights(), light);
  add(features.lashes(), material_of("lashes", Vector3f(0.012f, 0.009f, 0.008f), 0.9f));
  add(features.mouth_inside(), material_of("mouth", Vector3f(0.09f, 0.012f, 0.015f), 0.8f));
  add(features.teeth(), material_of("teeth", Vector3f(0.75f, 0.73f, 0.68f), 0.5f));
  add(features.lips(), material_of("lips", lips.colour, lips.roughness));
}

}  // namespace dance
