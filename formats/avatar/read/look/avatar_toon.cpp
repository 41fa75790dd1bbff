#include "formats/avatar/read/look/avatar_toon.h"

#include <cmath>

#include "formats/gltf/glb_json.h"

namespace dance {
namespace {

using tinygltf::Value;

float linear(double srgb) {
  const double value = std::min(std::max(srgb, 0.0), 1.0);
  return static_cast<float>(value <= 0.04045 ? value / 12.92
                                             : std::pow((value + 0.055) / 1.055, 2.4));
}

void read_vrm1(const Value& toon, AvatarMaterial& out) {
  out.shading = Shading::kToon;
  out.shade_colour.setZero();
  if (const auto shade = numbers_of<3>(member(&toon, "shadeColorFactor")))
    for (std::size_t c = 0; c < 3; ++c)
      out.shade_colour[static_cast<Eigen::Index>(c)] =
          static_cast<float>(std::min(std::max((*shade)[c], 0.0), 1.0));
  out.shade_shift = float_of(member(&toon, "shadingShiftFactor"), 0.0f, -1.0f, 1.0f);
  out.shade_toony = float_of(member(&toon, "shadingToonyFactor"), 0.9f, 0.0f, 1.0f);
}

struct Vrm0Material {
  const Value* floats;
  const Value* vectors;
  const Value* textures;

  float number(const char* name, float otherwise, float least, float most) const {
    return float_of(member(floats, name), otherwise, least, most);
  }
};

void read_vrm0_colours(const Vrm0Material& from, AvatarMaterial& out) {
  if (const auto colour = numbers_of<4>(member(from.vectors, "_Color"))) {
    for (std::size_t c = 0; c < 3; ++c)
      out.base_colour[static_cast<Eigen::Index>(c)] = linear((*colour)[c]);
    out.base_colour[3] = static_cast<float>(std::min(std::max((*colour)[3], 0.0), 1.0));
  }
  const auto shade = numbers_of<3>(member(from.vectors, "_ShadeColor"))
                         .value_or(std::array<double, 3>{0.97, 0.81, 0.86});
  for (std::size_t c = 0; c < 3; ++c)
    out.shade_colour[static_cast<Eigen::Index>(c)] = linear(shade[c]);
  const float shift = from.number("_ShadeShift", 0.0f, -1.0f, 1.0f);
  const float toony = from.number("_ShadeToony", 0.9f, 0.0f, 1.0f);
  // VRM 0.x shades from shift to shift + (1 − toony)(1 − shift), 1.0 about the middle of that.
  out.shade_toony = toony + (1.0f - toony) * (0.5f + 0.5f * shift);
  out.shade_shift = std::clamp(-shift - (1.0f - out.shade_toony), -1.0f, 1.0f);
}

void read_vrm0_blending(const Vrm0Material& from, AvatarMaterial& out) {
  if (const auto mode = number_of(member(from.floats, "_BlendMode"))) {
    if (*mode == 0.0) out.alpha_mode = AlphaMode::kOpaque;
    if (*mode == 1.0) out.alpha_mode = AlphaMode::kMask;
    if (*mode == 2.0 || *mode == 3.0) out.alpha_mode = AlphaMode::kBlend;
  }
  out.alpha_cutoff = from.number("_Cutoff", out.alpha_cutoff, 0.0f, 1.0f);
  if (const auto cull = number_of(member(from.floats, "_CullMode")))
    out.is_double_sided = *cull == 0.0;
}

// Unity counts v upwards: a picture's scale and offset are turned over.
void read_vrm0_picture(const Vrm0Material& from, AvatarPictures& pictures, AvatarMaterial& out,
                       MaterialUv& uv) {
  const auto texture = index_in(member(from.textures, "_MainTex"), 1u << 20);
  if (!texture) return;
  if (out.picture < 0) out.picture = pictures.of_texture(*texture);
  const auto placed = numbers_of<4>(member(from.vectors, "_MainTex"));
  if (!placed) return;
  const auto within = [](double value) {
    return static_cast<float>(std::min(std::max(value, -1e4), 1e4));
  };
  const auto& [x, y, width, height] = *placed;
  uv = {};
  uv.turn = Eigen::Vector2f(within(width), within(height)).asDiagonal();
  uv.offset = {within(x), 1.0f - within(height) - within(y)};
}

}  // namespace

void read_toon(const AvatarSource& source, std::size_t material, AvatarPictures& pictures,
               AvatarMaterial& out, MaterialUv& uv) {
  const auto& extensions = source.file.materials[material].extensions;
  if (const Value* toon = extension_of(extensions, "VRMC_materials_mtoon"))
    return read_vrm1(*toon, out);
  const Value* listed = member(extension_of(source.file.extensions, "VRM"), "materialProperties");
  const Value* properties = item(listed, material);
  const std::string shader = text_of(member(properties, "shader"));
  const Vrm0Material from{member(properties, "floatProperties"),
                          member(properties, "vectorProperties"),
                          member(properties, "textureProperties")};
  if (shader == "VRM/MToon") {
    out.shading = Shading::kToon;
    read_vrm0_colours(from, out);
    read_vrm0_blending(from, out);
    read_vrm0_picture(from, pictures, out, uv);
  } else if (shader.starts_with("VRM/Unlit")) {
    out.shading = Shading::kUnlit;
    if (shader == "VRM/UnlitCutout") out.alpha_mode = AlphaMode::kMask;
    if (shader.starts_with("VRM/UnlitTransparent")) out.alpha_mode = AlphaMode::kBlend;
    read_vrm0_picture(from, pictures, out, uv);
  }
}

}  // namespace dance
