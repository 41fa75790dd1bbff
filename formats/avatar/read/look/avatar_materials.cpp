#include "formats/avatar/read/look/avatar_materials.h"

#include <cmath>

#include "formats/avatar/read/look/avatar_pictures.h"
#include "formats/avatar/read/look/avatar_toon.h"
#include "formats/gltf/glb_json.h"
#include "formats/gltf/glb_text.h"

namespace dance {
namespace {

using tinygltf::Value;

constexpr float kBrightest = 100.0f;
constexpr float kFurthestUv = 1e4f;

float within(double value, float least, float most) {
  if (!std::isfinite(value)) return least;
  return std::clamp(static_cast<float>(value), least, most);
}

MaterialUv uv_of(const tinygltf::ExtensionMap& extensions, int set) {
  MaterialUv uv;
  uv.set = set;
  const Value* transform = extension_of(extensions, "KHR_texture_transform");
  if (!transform) return uv;
  const auto pair = [&](const char* name, double otherwise) {
    const auto numbers = numbers_of<2>(member(transform, name));
    return Eigen::Vector2f(within(numbers ? (*numbers)[0] : otherwise, -kFurthestUv, kFurthestUv),
                           within(numbers ? (*numbers)[1] : otherwise, -kFurthestUv, kFurthestUv));
  };
  uv.offset = pair("offset", 0.0);
  const float angle = float_of(member(transform, "rotation"), 0.0f, -100.0f, 100.0f);
  Eigen::Matrix2f turn;
  turn << std::cos(angle), std::sin(angle), -std::sin(angle), std::cos(angle);
  uv.turn = turn * pair("scale", 1.0).asDiagonal();
  if (const auto other = index_in(member(transform, "texCoord"), 8)) uv.set = *other;
  return uv;
}

void read_factors(const std::vector<double>& factors, AvatarMaterial& out) {
  for (std::size_t c = 0; c < 4 && c < factors.size(); ++c)
    out.base_colour[static_cast<Eigen::Index>(c)] = within(factors[c], 0.0f, 1.0f);
}

void read_emission(const tinygltf::Material& material, AvatarMaterial& out, AvatarSource& source) {
  if (material.emissiveFactor.size() < 3) return;
  const float strength =
      float_of(member(extension_of(material.extensions, "KHR_materials_emissive_strength"),
                      "emissiveStrength"),
               1.0f, 0.0f, kBrightest);
  for (std::size_t c = 0; c < 3; ++c)
    out.emission[static_cast<Eigen::Index>(c)] =
        std::min(strength * within(material.emissiveFactor[c], 0.0f, kBrightest), kBrightest);
  // A picture says where it glows: without it all of the surface would.
  if (material.emissiveTexture.index < 0 || out.emission.isZero()) return;
  out.emission.setZero();
  source.note("pictures of glowing parts are not shown");
}

void read_alpha(const tinygltf::Material& material, AvatarMaterial& out) {
  if (material.alphaMode == "MASK") out.alpha_mode = AlphaMode::kMask;
  if (material.alphaMode == "BLEND") out.alpha_mode = AlphaMode::kBlend;
  out.alpha_cutoff = within(material.alphaCutoff, 0.0f, 1.0f);
}

// What exporters wrote before metal and roughness.
void read_specular(const tinygltf::Material& material, AvatarMaterial& out, MaterialUv& uv,
                   AvatarPictures& pictures) {
  const Value* specular = extension_of(material.extensions, "KHR_materials_pbrSpecularGlossiness");
  if (!specular) return;
  if (const auto diffuse = numbers_of<4>(member(specular, "diffuseFactor")))
    read_factors({diffuse->begin(), diffuse->end()}, out);
  out.roughness = 1.0f - float_of(member(specular, "glossinessFactor"), 0.2f, 0.0f, 1.0f);
  const Value* texture = member(specular, "diffuseTexture");
  if (!texture) return;
  const auto index = index_in(member(texture, "index"), 1u << 20);
  out.picture = pictures.of_texture(index.value_or(-1));
  uv = uv_of({}, index_in(member(texture, "texCoord"), 8).value_or(0));
}

}  // namespace

Result<std::vector<MaterialUv>> read_materials(AvatarSource& source) {
  const auto& materials = source.file.materials;
  if (materials.size() > source.limits.materials)
    return fail("more than " + std::to_string(source.limits.materials) +
                " materials; join some of them");
  AvatarPictures pictures(source);
  std::vector<MaterialUv> uvs;
  for (std::size_t m = 0; m < materials.size(); ++m) {
    const tinygltf::Material& material = materials[m];
    const auto& surface = material.pbrMetallicRoughness;
    AvatarMaterial out;
    out.name = plain_name(material.name);
    read_factors(surface.baseColorFactor, out);
    out.roughness = within(surface.roughnessFactor, 0.0f, 1.0f);
    out.is_double_sided = material.doubleSided;
    read_alpha(material, out);
    read_emission(material, out, source);
    MaterialUv uv = uv_of(surface.baseColorTexture.extensions, surface.baseColorTexture.texCoord);
    if (surface.baseColorTexture.index >= 0)
      out.picture = pictures.of_texture(surface.baseColorTexture.index);
    read_specular(material, out, uv, pictures);
    if (extension_of(material.extensions, "KHR_materials_unlit")) out.shading = Shading::kUnlit;
    read_toon(source, m, pictures, out, uv);
    source.model.materials.push_back(std::move(out));
    uvs.push_back(uv);
  }
  return uvs;
}

}  // namespace dance
