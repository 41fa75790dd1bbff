// Avatars that are damaged, or made to do harm.
#include <gtest/gtest.h>

#include <limits>

#include "formats/avatar/avatar_reader.h"
#include "tests/formats/avatar/rich_avatar.h"
#include "tests/formats/picture/packed_pictures.h"

namespace dance {
namespace {

using nlohmann::json;
using test::Bytes;
using test::TinyAvatar;

// Sound or refused, and all that is said of it printable.
void expect_no_harm(const Bytes& bytes, const AvatarLimits& limits = {}) {
  // A block of exactly this size, so that a sanitizer sees a read beyond its end.
  const std::vector<std::uint8_t> exact(bytes.begin(), bytes.end());
  const auto read = read_avatar(exact, limits);
  std::string said = read ? read->model.name + read->model.licence : read.error().what;
  ASSERT_FALSE(!read && said.empty());
  if (read) {
    ASSERT_TRUE(is_sound(read->model));
    for (const std::string& note : read->notes) said += note;
    for (const AvatarNode& node : read->model.nodes) said += node.name;
    for (const AvatarMorph& morph : read->model.morphs) said += morph.name;
    for (const AvatarExpression& expression : read->model.expressions) said += expression.name;
    for (const AvatarMaterial& material : read->model.materials) said += material.name;
  }
  for (const char c : said) ASSERT_TRUE(c >= 0x20 && c < 0x7f) << said;
}

std::string error_of(const TinyAvatar& avatar, const AvatarLimits& limits = {}) {
  const auto read = read_avatar(avatar.glb(), limits);
  return read ? "was read" : read.error().what;
}

void expect_error(const TinyAvatar& avatar, const std::string& part,
                  const AvatarLimits& limits = {}) {
  const std::string error = error_of(avatar, limits);
  EXPECT_NE(error.find(part), error.npos) << error;
}

TEST(AvatarHostile, TheCorpusItselfIsRead) {
  for (const TinyAvatar& avatar : {test::rich_vrm0(), test::rich_vrm1(), test::plain_glb()}) {
    const auto read = read_avatar(avatar.glb());
    ASSERT_TRUE(read) << read.error().what;
    EXPECT_TRUE(read->notes.empty()) << read->notes.front();
    const auto text = read_avatar(avatar.gltf());
    ASSERT_TRUE(text) << text.error().what;
    EXPECT_EQ(text->model.vertices.size(), read->model.vertices.size());
  }
  const AvatarModel model = read_avatar(test::rich_vrm1().glb())->model;
  EXPECT_EQ(model.pictures.size(), 3u);
  EXPECT_EQ(model.morphs.size(), 2u);
  EXPECT_EQ(model.springs.size(), 1u);
}

TEST(AvatarHostile, NoPrefixDoesHarm) {
  for (const TinyAvatar& avatar : {test::rich_vrm0(), test::rich_vrm1(), test::plain_glb()}) {
    const Bytes whole = avatar.glb();
    for (std::size_t size = 0; size < whole.size(); size += size < 64 ? 1 : 7)
      expect_no_harm(Bytes(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size)));
    // Its header telling the truth, what accessors and pictures name is beyond the end.
    for (std::size_t kept = 0; kept < avatar.bin_bytes(); kept += 5)
      expect_no_harm(avatar.glb(kept));
  }
  const Bytes text = test::plain_glb().gltf();
  for (std::size_t size = 0; size < text.size(); size += 3)
    expect_no_harm(Bytes(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(size)));
}

TEST(AvatarHostile, NoFlippedBitDoesHarm) {
  for (const TinyAvatar& avatar : {test::rich_vrm0(), test::rich_vrm1()}) {
    Bytes bytes = avatar.glb();
    for (std::size_t i = 0; i < bytes.size(); i += 4) {
      const auto bit = static_cast<std::uint8_t>(1u << (i / 4 * 5 % 8));
      bytes[i] ^= bit;
      expect_no_harm(bytes);
      bytes[i] ^= bit;
    }
  }
}

// Each number of the JSON, in turn, is an extreme one; then each text; then each thing is gone.
TEST(AvatarHostile, NoExtremeNumberDoesHarm) {
  const json extremes = {-1,          0,     255,  65536, 2147483647, -2147483648,
                         4294967296u, 1e300, -0.0, 1e-40, "x\x1b",    nullptr};
  for (const TinyAvatar& from : {test::rich_vrm0(), test::rich_vrm1()}) {
    const json flat = from.json.flatten();
    std::size_t turn = 0;
    for (const auto& [pointer, value] : flat.items()) {
      for (int k = 0; k < 3; ++k) {
        TinyAvatar avatar = from;
        avatar.json[json::json_pointer(pointer)] = extremes[turn++ % extremes.size()];
        expect_no_harm(avatar.glb());
      }
    }
  }
}

TEST(AvatarHostile, NoMissingPartDoesHarm) {
  for (const TinyAvatar& from : {test::rich_vrm0(), test::rich_vrm1()}) {
    const json flat = from.json.flatten();
    for (const auto& [pointer, value] : flat.items()) {
      TinyAvatar avatar = from;
      json::json_pointer at(pointer);
      const std::string last = at.back();
      at.pop_back();
      json& parent = avatar.json[at];
      if (parent.is_object())
        parent.erase(last);
      else
        parent.erase(std::stoul(last));
      expect_no_harm(avatar.glb());
    }
  }
}

TEST(AvatarHostile, IndicesOutsideAreNamed) {
  const auto changed = [](const char* pointer, const json& value) {
    TinyAvatar avatar = test::rich_vrm1();
    avatar.json[json::json_pointer(pointer)] = value;
    return avatar;
  };
  expect_error(changed("/meshes/0/primitives/0/material", 9), "material that is not");
  expect_error(changed("/skins/0/joints/0", 999), "joint that is not in the file");
  expect_error(changed("/meshes/0/primitives/0/attributes/POSITION", 999), "");
  expect_error(changed("/meshes/0/primitives/0/attributes/NORMAL", 0), "");
  expect_error(changed("/nodes/0/children/0", 0), "below themselves");
  TinyAvatar avatar = test::rich_vrm1();
  avatar.json["meshes"][0]["primitives"][0]["indices"] =
      avatar.add_integers<std::uint16_t>({0, 1, 4}, "SCALAR");
  expect_error(avatar, "vertex that is not in the file");
  avatar = test::rich_vrm1();
  avatar.json["meshes"][0]["primitives"][0]["attributes"]["JOINTS_0"] =
      avatar.add_integers<std::uint16_t>(std::vector<std::uint16_t>(16, 500), "VEC4");
  expect_error(avatar, "joint that its skin does not have");
}

TEST(AvatarHostile, NumbersThatAreNoneAreRefused) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float infinite = std::numeric_limits<float>::infinity();
  for (const float bad : {nan, infinite, 1e30f}) {
    TinyAvatar avatar = test::rich_vrm1();
    avatar.json["meshes"][0]["primitives"][0]["attributes"]["POSITION"] =
        avatar.add_floats({0, 0, 0, 0, bad, 0, 0, 0, 0, 0, 0, 0}, "VEC3");
    EXPECT_NE(error_of(avatar), "was read");
    avatar = test::rich_vrm1();
    const std::size_t joints = avatar.json["skins"][0]["joints"].size();
    avatar.json["skins"][0]["inverseBindMatrices"] =
        avatar.add_floats(std::vector<float>(16 * joints, bad), "MAT4");
    EXPECT_NE(error_of(avatar), "was read");
  }
}

TEST(AvatarHostile, TooMuchOfAnythingIsRefusedByName) {
  const TinyAvatar avatar = test::rich_vrm1();
  const auto with = [](auto AvatarLimits::*limit, auto value) {
    AvatarLimits limits;
    limits.*limit = value;
    return limits;
  };
  expect_error(avatar, "MiB", with(&AvatarLimits::file_bytes, std::size_t{1000}));
  expect_error(avatar, "objects", with(&AvatarLimits::json_objects, std::size_t{20}));
  expect_error(avatar, "nodes", with(&AvatarLimits::nodes, std::size_t{20}));
  expect_error(avatar, "joints", with(&AvatarLimits::joints, std::size_t{20}));
  expect_error(avatar, "vertices", with(&AvatarLimits::vertices, std::size_t{7}));
  expect_error(avatar, "triangles", with(&AvatarLimits::triangles, std::size_t{3}));
  expect_error(avatar, "parts", with(&AvatarLimits::parts, std::size_t{1}));
  expect_error(avatar, "materials", with(&AvatarLimits::materials, std::size_t{2}));
  expect_error(avatar, "morph", with(&AvatarLimits::morphs, std::size_t{1}));
  expect_error(avatar, "morph", with(&AvatarLimits::morph_moves, std::size_t{1}));
  expect_error(avatar, "numbers", with(&AvatarLimits::numbers, std::size_t{50}));
  expect_error(avatar, "MiB", with(&AvatarLimits::bytes, std::size_t{400}));
  const auto counted = [&](const AvatarLimits& limits) {
    const auto read = read_avatar(avatar.glb(), limits);
    EXPECT_TRUE(read) << read.error().what;
    return std::array{read->model.pictures.size(), read->model.expressions.size(),
                      read->model.springs.size(), read->model.colliders.size(), read->notes.size()};
  };
  EXPECT_EQ(counted({}), (std::array<std::size_t, 5>{3, 1, 1, 2, 0}));
  EXPECT_EQ(counted(with(&AvatarLimits::pictures, std::size_t{1}))[0], 1u);
  EXPECT_EQ(counted(with(&AvatarLimits::expressions, std::size_t{0}))[1], 0u);
  EXPECT_EQ(counted(with(&AvatarLimits::spring_joints, std::size_t{1}))[2], 0u);
  EXPECT_EQ(counted(with(&AvatarLimits::colliders, std::size_t{1}))[3], 1u);
}

TEST(AvatarHostile, AnAccessorOverNothingTakesNoMemory) {
  TinyAvatar avatar = test::rich_vrm1();
  auto& accessors = avatar.json["accessors"];
  const json primitive = avatar.json["meshes"][0]["primitives"][0];
  accessors[primitive["attributes"]["POSITION"].get<std::size_t>()]["count"] = 2147483647;
  expect_error(avatar, "vertices");
  avatar = test::rich_vrm1();
  avatar.json["accessors"][primitive["indices"].get<std::size_t>()]["count"] = 1'800'000;
  expect_error(avatar, "beyond its buffer view");
}

// A PNG of a few kilobytes that is many pixels, many times over.
TEST(AvatarHostile, PicturesThatUnpackToMuchAreCounted) {
  TinyAvatar avatar = test::plain_glb();
  const Bytes bomb = test::png(1200, 1200, 0);
  AvatarLimits limits;
  limits.decoded_bytes = std::size_t{4} * 1200 * 1200 * 2;
  for (int p = 0; p < 6; ++p) {
    const int texture = avatar.add_picture(bomb, "image/png");
    avatar.json["materials"].push_back(
        {{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", texture}}}}}});
  }
  const auto read = read_avatar(avatar.glb(), limits);
  ASSERT_TRUE(read) << read.error().what;
  EXPECT_EQ(read->model.pictures.size(), 2u);
  EXPECT_EQ(read->model.pictures[0].width_px, 600);
}

TEST(AvatarHostile, PackedMeshesAreRefusedWithTheCure) {
  TinyAvatar avatar = test::plain_glb();
  avatar.json["extensionsUsed"] = {"KHR_draco_mesh_compression"};
  expect_error(avatar, "without compression");
}

}  // namespace
}  // namespace dance
