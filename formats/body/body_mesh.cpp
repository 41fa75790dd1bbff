#include "formats/body/body_mesh.h"

#include <array>

#include "formats/body/figure_builder.h"
#include "formats/body/implicit_surface.h"

namespace dance {

using Eigen::Vector3f;

namespace {

std::vector<BodyMeshPart> mesh_of(const std::vector<FigureLayer>& layers,
                                  const Skeleton& skeleton) {
  const SkinWeighting weighting(skeleton);
  std::array<BodyMeshPart, kMaterialCount> of_material;
  for (const FigureLayer& layer : layers) {
    BodyMeshPart& part = of_material[static_cast<std::size_t>(layer.material)];
    const Surface surface = surface_of(layer);
    const auto first = static_cast<std::uint32_t>(part.places_m.size());
    for (const std::uint32_t vertex : surface.triangles) part.triangles.push_back(first + vertex);
    part.places_m.insert(part.places_m.end(), surface.places_m.begin(), surface.places_m.end());
    part.normals.insert(part.normals.end(), surface.normals.begin(), surface.normals.end());
    for (const Vector3f& place_m : surface.places_m)
      part.skin.push_back(weighting.weights_at(place_m, layer));
  }
  std::vector<BodyMeshPart> parts;
  for (std::size_t m = 0; m < kMaterialCount; ++m) {
    if (of_material[m].triangles.empty()) continue;
    of_material[m].material = static_cast<Material>(m);
    parts.push_back(std::move(of_material[m]));
  }
  return parts;
}

}  // namespace

std::vector<BodyMeshPart> body_mesh(const Skeleton& skeleton, const GuestLook& look,
                                    bool has_fingers) {
  return mesh_of(FigureBuilder(skeleton, look, has_fingers).take(), skeleton);
}

std::vector<BodyMeshPart> body_mesh_below_head(const Skeleton& skeleton, const GuestLook& look,
                                               bool has_fingers) {
  return mesh_of(FigureBuilder(skeleton, look, has_fingers).take_below_head(), skeleton);
}

MaterialLook look_of(Material material, const GuestLook& look) {
  switch (material) {
    case Material::kSkin:
      return {"skin", look.skin, 0.65f};
    case Material::kTop:
      return {"top", look.top, 0.85f};
    case Material::kLegs:
      return {look.legwear == Legwear::kSkirt ? "skirt" : "trousers", look.legs, 0.85f};
    case Material::kShoes:
      return {"shoes", look.shoes, 0.45f};
    case Material::kSoles:
      return {"soles", 0.25f * look.shoes + Vector3f::Constant(0.01f), 0.8f};
    case Material::kHair:
      return {"hair", look.hair, 0.6f};
    case Material::kEyeWhite:
      return {"eyes", Vector3f(0.8f, 0.78f, 0.75f), 0.4f};
    case Material::kIris:
      return {"irises", Vector3f(0.015f, 0.012f, 0.012f), 0.2f};
    case Material::kLips:
      return {"lips", look.skin.cwiseProduct(Vector3f(0.75f, 0.38f, 0.36f)), 0.6f};
  }
  return {"skin", look.skin, 0.65f};
}

}  // namespace dance
