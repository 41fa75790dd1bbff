// Materials and their pictures: glTF's own, MToon of either VRM, unlit ones.
#include <gtest/gtest.h>

#include "tests/formats/avatar/read_well.h"
#include "tests/formats/picture/packed_pictures.h"

namespace dance {
namespace {

using nlohmann::json;
using test::Bytes;
using test::read_well;
using test::TinyAvatar;

TinyAvatar with_material(const json& material) {
  TinyAvatar avatar;
  json primitive = avatar.square();
  primitive["material"] = 0;
  avatar.json["materials"] = json::array({material});
  avatar.add_mesh(primitive);
  return avatar;
}

AvatarMaterial material_of(const TinyAvatar& avatar) {
  const AvatarModel model = test::model_of(avatar);
  return model.materials.empty() ? AvatarMaterial{} : model.materials[0];
}

TEST(AvatarLook, AMaterialOfGltfIsReadAsItIsWritten) {
  const AvatarMaterial material = material_of(with_material(
      {{"name", "cloth"},
       {"pbrMetallicRoughness",
        {{"baseColorFactor", {0.1, 0.2, 7.0, 0.5}}, {"roughnessFactor", 0.3}}},
       {"emissiveFactor", {0.5, 0, 0}},
       {"extensions", {{"KHR_materials_emissive_strength", {{"emissiveStrength", 3}}}}},
       {"alphaMode", "MASK"},
       {"alphaCutoff", 0.25},
       {"doubleSided", true}}));
  EXPECT_EQ(material.name, "cloth");
  EXPECT_EQ(material.base_colour, Eigen::Vector4f(0.1f, 0.2f, 1.0f, 0.5f));
  EXPECT_FLOAT_EQ(material.roughness, 0.3f);
  EXPECT_EQ(material.emission, Eigen::Vector3f(1.5f, 0, 0));
  EXPECT_EQ(material.alpha_mode, AlphaMode::kMask);
  EXPECT_FLOAT_EQ(material.alpha_cutoff, 0.25f);
  EXPECT_TRUE(material.is_double_sided);
  EXPECT_EQ(material.shading, Shading::kLit);
  EXPECT_EQ(material_of(with_material({{"alphaMode", "BLEND"}})).alpha_mode, AlphaMode::kBlend);
  EXPECT_EQ(material_of(with_material({{"extensions", {{"KHR_materials_unlit", json::object()}}}}))
                .shading,
            Shading::kUnlit);
}

TEST(AvatarLook, MtoonOfVrm1IsReadAsItIsWritten) {
  const AvatarMaterial material =
      material_of(with_material({{"extensions",
                                  {{"VRMC_materials_mtoon",
                                    {{"shadeColorFactor", {0.5, 0.25, 0.125}},
                                     {"shadingShiftFactor", -0.2},
                                     {"shadingToonyFactor", 0.8}}}}}}));
  EXPECT_EQ(material.shading, Shading::kToon);
  EXPECT_EQ(material.shade_colour, Eigen::Vector3f(0.5f, 0.25f, 0.125f));
  EXPECT_FLOAT_EQ(material.shade_shift, -0.2f);
  EXPECT_FLOAT_EQ(material.shade_toony, 0.8f);
}

TEST(AvatarLook, MtoonOfVrm0IsBroughtToThatOfVrm1) {
  TinyAvatar avatar = with_material({{"name", "skin"}, {"alphaMode", "OPAQUE"}});
  auto& properties = avatar.json["extensions"]["VRM"]["materialProperties"];
  properties = {
      {{"shader", "VRM/MToon"},
       {"floatProperties",
        {{"_ShadeShift", 0.0},
         {"_ShadeToony", 0.8},
         {"_BlendMode", 1},
         {"_Cutoff", 0.4},
         {"_CullMode", 0}}},
       {"vectorProperties", {{"_Color", {0.5, 1, 0, 1}}, {"_ShadeColor", {0, 0.5, 1, 1}}}}}};
  const AvatarMaterial material = material_of(avatar);
  EXPECT_EQ(material.shading, Shading::kToon);
  EXPECT_NEAR(material.base_colour.x(), 0.21404f, 1e-4f);  // of sRGB 0.5
  EXPECT_NEAR(material.shade_colour.y(), 0.21404f, 1e-4f);
  EXPECT_FLOAT_EQ(material.shade_toony, 0.9f);
  EXPECT_FLOAT_EQ(material.shade_shift, -0.1f);
  EXPECT_EQ(material.alpha_mode, AlphaMode::kMask);
  EXPECT_FLOAT_EQ(material.alpha_cutoff, 0.4f);
  EXPECT_TRUE(material.is_double_sided);
  properties[0]["shader"] = "VRM/UnlitTransparent";
  EXPECT_EQ(material_of(avatar).shading, Shading::kUnlit);
  EXPECT_EQ(material_of(avatar).alpha_mode, AlphaMode::kBlend);
  properties[0]["shader"] = "VRM_USE_GLTFSHADER";
  EXPECT_EQ(material_of(avatar).shading, Shading::kLit);
}

TinyAvatar with_picture(const Bytes& bytes, const std::string& mime) {
  TinyAvatar avatar = with_material({});
  const int texture = avatar.add_picture(bytes, mime);
  avatar.json["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"] = {{"index", texture}};
  return avatar;
}

TEST(AvatarLook, PicturesOfThreeKindsAreDecoded) {
  for (const auto& [bytes, mime] :
       {std::pair(test::png(6, 4), "image/png"), std::pair(test::jpeg(6, 4), "image/jpeg")}) {
    const auto result = read_well(with_picture(bytes, mime));
    EXPECT_TRUE(result.notes.empty());
    ASSERT_EQ(result.model.pictures.size(), 1u) << mime;
    EXPECT_EQ(result.model.pictures[0].width_px, 6);
    EXPECT_EQ(result.model.pictures[0].height_px, 4);
    EXPECT_EQ(result.model.materials[0].picture, 0);
  }
  // A WebP beside a PNG is taken instead of it.
  TinyAvatar avatar = with_picture(test::png(6, 4), "image/png");
  avatar.add_picture(test::webp(5, 3), "image/webp");
  avatar.json["textures"][0]["extensions"]["EXT_texture_webp"]["source"] = 1;
  const auto result = read_well(avatar);
  ASSERT_EQ(result.model.pictures.size(), 1u);
  EXPECT_EQ(result.model.pictures[0].width_px, 5);
}

TEST(AvatarLook, APictureInADataUriIsDecodedOneInAnotherFileIsNot) {
  TinyAvatar avatar = with_picture(test::png(1, 1), "image/png");
  avatar.json["images"][0] = {
      {"uri",
       "data:image/png;base64,"
       "iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR42mNk+M9QDwADhgGA"
       "WjR9awAAAABJRU5ErkJggg=="}};
  ReadAvatar result = read_well(avatar);
  EXPECT_EQ(result.model.pictures.size(), 1u);
  avatar.json["images"][0] = {{"uri", "../../etc/passwd.png"}};
  result = read_well(avatar);
  EXPECT_TRUE(result.model.pictures.empty());
  ASSERT_EQ(result.notes.size(), 1u);
  EXPECT_NE(result.notes[0].find("another file"), std::string::npos);
}

TEST(AvatarLook, APictureIsDecodedOnceForAllMaterials) {
  TinyAvatar avatar = with_picture(test::png(2, 2), "image/png");
  avatar.json["materials"].push_back(avatar.json["materials"][0]);
  avatar.json["textures"].push_back(avatar.json["textures"][0]);
  avatar.json["materials"][1]["pbrMetallicRoughness"]["baseColorTexture"]["index"] = 1;
  const auto result = read_well(avatar);
  EXPECT_EQ(result.model.pictures.size(), 1u);
  EXPECT_EQ(result.model.materials[1].picture, 0);
}

TEST(AvatarLook, WithoutItsPictureAMaterialKeepsItsColour) {
  Bytes cut = test::png(64, 64);
  cut.resize(cut.size() / 2);
  Bytes huge = test::png(2, 2);
  huge[17] = 0x7f;  // of the width; the check sum of the header is wrong then as well
  for (const Bytes& bytes : {cut, huge, Bytes{1, 2, 3, 4}, test::png(5000, 1)}) {
    TinyAvatar avatar = with_picture(bytes, "image/png");
    avatar.json["materials"][0]["pbrMetallicRoughness"]["baseColorFactor"] = {1, 0, 0, 1};
    const auto result = read_well(avatar);
    EXPECT_EQ(result.model.materials[0].picture, -1);
    EXPECT_EQ(result.model.materials[0].base_colour, Eigen::Vector4f(1, 0, 0, 1));
    ASSERT_EQ(result.notes.size(), 1u);
    for (const char c : result.notes[0]) EXPECT_TRUE(c >= 0x20 && c < 0x7f);
  }
}

TEST(AvatarLook, LargePicturesAreMadeSmallerAndTheirSumIsBounded) {
  AvatarLimits limits;
  limits.reduced_side_px = 16;
  ReadAvatar result = read_well(with_picture(test::png(64, 40), "image/png"), limits);
  ASSERT_EQ(result.model.pictures.size(), 1u);
  EXPECT_EQ(result.model.pictures[0].width_px, 16);
  EXPECT_EQ(result.model.pictures[0].height_px, 10);
  limits.decoded_bytes = 4 * 64 * 40 - 1;
  result = read_well(with_picture(test::png(64, 40), "image/png"), limits);
  EXPECT_TRUE(result.model.pictures.empty());
  EXPECT_EQ(result.notes.size(), 1u);
}

std::vector<Eigen::Vector2f> uv_of(const TinyAvatar& avatar) {
  const auto result = read_well(avatar);
  std::vector<Eigen::Vector2f> uv;
  for (const AvatarVertex& vertex : result.model.vertices) uv.push_back(vertex.uv);
  return uv;
}

TEST(AvatarLook, TheTransformOfAPictureIsBakedIntoTheUv) {
  TinyAvatar avatar = with_picture(test::png(2, 2), "image/png");
  auto& texture = avatar.json["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"];
  texture["extensions"]["KHR_texture_transform"] = {{"offset", {0.5, 0.25}}, {"scale", {0.5, 2.0}}};
  auto uv = uv_of(avatar);  // of (0, 1), (1, 1), (1, 0), (0, 0)
  ASSERT_EQ(uv.size(), 4u);
  EXPECT_EQ(uv[1], Eigen::Vector2f(1.0f, 2.25f));
  EXPECT_EQ(uv[3], Eigen::Vector2f(0.5f, 0.25f));
  // Turned by a quarter, counter-clockwise about the upper left corner: u goes to -v.
  texture["extensions"]["KHR_texture_transform"] = {{"rotation", 1.57079632679}};
  uv = uv_of(avatar);
  EXPECT_LT((uv[2] - Eigen::Vector2f(0.0f, -1.0f)).norm(), 1e-6f);
  EXPECT_LT((uv[0] - Eigen::Vector2f(1.0f, 0.0f)).norm(), 1e-6f);
}

TEST(AvatarLook, UnitysOffsetOfAPictureCountsFromBelow) {
  TinyAvatar avatar = with_picture(test::png(2, 2), "image/png");
  avatar.json["extensions"]["VRM"]["materialProperties"] = {
      {{"shader", "VRM/MToon"},
       {"textureProperties", {{"_MainTex", 0}}},
       {"vectorProperties", {{"_MainTex", {0.5, 0.0, 0.5, 0.5}}}}}};
  // The right half of the lower half.
  const auto uv = uv_of(avatar);
  ASSERT_EQ(uv.size(), 4u);
  EXPECT_EQ(uv[3], Eigen::Vector2f(0.5f, 0.5f));
  EXPECT_EQ(uv[1], Eigen::Vector2f(1.0f, 1.0f));
}

TEST(AvatarLook, AnotherSetOfUvIsTakenWhereThePictureWantsIt) {
  TinyAvatar avatar;
  json primitive = avatar.square();
  primitive["material"] = 0;
  primitive["attributes"]["TEXCOORD_1"] =
      avatar.add_floats({0.5f, 0.5f, 0.5f, 0.5f, 0.5f, 0.5f, 0.5f, 0.5f}, "VEC2");
  avatar.add_mesh(primitive);
  const int texture = avatar.add_picture(test::png(2, 2), "image/png");
  avatar.json["materials"] = {
      {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", texture}, {"texCoord", 1}}}}}}};
  const auto uv = uv_of(avatar);
  ASSERT_EQ(uv.size(), 4u);
  EXPECT_EQ(uv[0], Eigen::Vector2f(0.5f, 0.5f));
}

}  // namespace
}  // namespace dance
