#include "formats/avatar/mannequin_model.h"

#include "formats/avatar/make/mannequin_head.h"
#include "formats/body/body_mesh.h"

namespace dance {
namespace {

int add_material(ModelBuilder& builder, Material material, const GuestLook& look) {
  const MaterialLook material_look = look_of(material, look);
  AvatarMaterial out;
  out.name = material_look.name;
  out.base_colour.head<3>() = material_look.colour;
  out.roughness = material_look.roughness;
  return builder.add_material(std::move(out));
}

Sheet build_sheet(const BodyMeshPart& part) {
  Sheet sheet;
  sheet.triangles = part.triangles;
  for (std::size_t v = 0; v < part.places_m.size(); ++v) {
    AvatarVertex vertex = vertex_at(part.places_m[v]);
    vertex.normal = part.normals[v];
    for (std::size_t k = 0; k < 4; ++k) vertex.joints[k] = part.skin[v].joints[k];
    vertex.weights = part.skin[v].weights;
    sheet.vertices.push_back(vertex);
  }
  return sheet;
}

}  // namespace

AvatarModel mannequin_model(const Skeleton& skeleton, const GuestLook& look, bool has_fingers) {
  ModelBuilder builder(skeleton);
  int skin = -1;
  for (const BodyMeshPart& part : body_mesh_below_head(skeleton, look, has_fingers)) {
    const int material = add_material(builder, part.material, look);
    if (part.material == Material::kSkin) skin = material;
    builder.add_sheet(build_sheet(part), material);
  }
  if (skin < 0) skin = add_material(builder, Material::kSkin, look);
  const int hair = add_material(builder, Material::kHair, look);
  add_mannequin_head(skeleton, look, skin, hair, builder);
  return builder.take("mannequin", "");
}

}  // namespace dance
