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
  expect_error(avatar, "to look at", with(&AvatarLimits::looks, std::size_t{20}));
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

// How often a reader with these limits asked whether it is to stop: a measure of its work.
std::size_t asked_in(const TinyAvatar& avatar, const AvatarLimits& limits, std::string& error) {
  std::size_t asked = 0;
  const auto read = read_avatar(avatar.glb(), limits, {}, [&] {
    ++asked;
    return false;
  });
  error = read ? "" : read.error().what;
  return asked;
}

// A small file in which all of many nodes have one mesh and one skin.
TinyAvatar with_many_nodes(std::size_t nodes, std::size_t joints, std::size_t primitives) {
  TinyAvatar avatar;
  json square = avatar.square();
  avatar.add_mesh(json(primitives, square));
  // Its bones are told, so that it needs no skin to be found.
  json& bones = avatar.json["extensions"]["VRMC_vrm"]["humanoid"]["humanBones"];
  for (const Bone bone : kNeededBones) {
    const std::string name(kBones[index_of(bone)].name);
    bones[name]["node"] = avatar.node(name);
  }
  int deep = avatar.node("mesh");
  for (int i = 0; i < 100; ++i) deep = avatar.add_node("deep", deep, {0, 0, 0});
  if (joints > 0) avatar.json["skins"][0] = {{"joints", json(joints, deep)}};
  for (std::size_t n = 0; n < nodes; ++n)
    avatar.json["nodes"].push_back({{"mesh", 0}, {"skin", 0}});
  return avatar;
}

TEST(AvatarHostile, ASkinOfTooManyJointsIsRefusedBeforeTheyAreLookedAt) {
  std::string error;
  const std::size_t asked = asked_in(with_many_nodes(3900, 10'000, 1), {}, error);
  EXPECT_NE(error.find("skin 0 has 10000 joints"), error.npos) << error;
  EXPECT_LT(asked, 10u);
}

TEST(AvatarHostile, ASkinIsLookedAtOnceHoweverManyNodesHaveIt) {
  // 1000 joints beside the figure, so that no node's mesh is read.
  AvatarLimits limits;
  limits.looks = 1000;
  const auto read = read_avatar(with_many_nodes(3800, 1000, 1).glb(), limits);
  ASSERT_FALSE(read);
  EXPECT_EQ(read.error().what, "no mesh that hangs from the figure");
  limits.looks = 999;
  expect_error(with_many_nodes(3800, 1000, 1), "more than 999 primitives", limits);
}

TEST(AvatarHostile, AMeshOfManyPrimitivesCannotBeSharedByManyNodes) {
  std::string error;
  const TinyAvatar avatar = with_many_nodes(3900, 0, 5'000);
  const std::size_t asked = asked_in(avatar, {}, error);
  EXPECT_NE(error.find("join its meshes"), error.npos) << error;
  EXPECT_LT(asked, 400'000u);
  EXPECT_EQ(error_of(with_many_nodes(8, 0, 300)), "was read");
}

// Each skin compared with each other would be hours of work.
TEST(AvatarHostile, TheFigureIsFoundAmongVeryManySkins) {
  TinyAvatar avatar;
  avatar.add_mesh(avatar.square());
  int deep = avatar.add_node("other", -1, {0, 0, 0});
  for (int i = 0; i < 100; ++i) deep = avatar.add_node("deep", deep, {0, 0, 0});
  const std::size_t first = avatar.json["nodes"].size();
  for (std::size_t n = first; n < 4000; ++n) {
    avatar.json["nodes"].push_back(json::object());
    avatar.json["skins"].push_back({{"joints", json::array({n})}});
  }
  for (int i = 0; i < 30'000; ++i)
    avatar.json["skins"].push_back({{"joints", json::array({deep - i % 50})}});
  EXPECT_EQ(error_of(avatar), "was read");
}

TEST(AvatarHostile, ReadingStopsSoonAfterItIsTold) {
  const TinyAvatar avatar = test::rich_vrm1();
  std::string error;
  const std::size_t all = asked_in(avatar, {}, error);
  EXPECT_EQ(error, "");
  ASSERT_GT(all, 8u);  // between the parts of the file, meshes, primitives and pictures
  for (std::size_t last = 1; last <= all; ++last) {
    std::size_t asked = 0;
    const auto read = read_avatar(avatar.glb(), {}, {}, [&] { return ++asked >= last; });
    ASSERT_FALSE(read);
    EXPECT_NE(read.error().what.find("stopped"), std::string::npos) << read.error().what;
    EXPECT_LE(asked, last + 3);  // a picture less costs a note, and the next thing asks again
  }
}

TEST(AvatarHostile, PackedMeshesAreRefusedWithTheCure) {
  TinyAvatar avatar = test::plain_glb();
  avatar.json["extensionsUsed"] = {"KHR_draco_mesh_compression"};
  expect_error(avatar, "without compression");
}

}  // namespace
}  // namespace dance
