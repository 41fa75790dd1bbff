// Figures written as VRM 1.0: what is in the file, and that our own reader gives the figure back.
#include "formats/avatar/vrm_writer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "formats/avatar/avatar_reader.h"
#include "formats/avatar/mannequin_model.h"
#include "tests/formats/avatar/glb_json.h"

namespace dance {
namespace {

using Eigen::Affine3f;
using Eigen::Vector3f;
using nlohmann::json;

VrmMeta meta() {
  VrmMeta meta;
  meta.authors = {"a tailor", "a hairdresser"};
  meta.licence_url = "https://example.org/licence";
  return meta;
}

// A mannequin plus a picture, toon shading, a spring and one more morph.
AvatarModel dressed() {
  AvatarModel model =
      mannequin_model(average_skeleton(1.6f), look_of(*GuestId::parse("alice")), true);
  model.morphs.clear();
  model.expressions.clear();
  AvatarPicture picture;
  picture.width_px = 2;
  picture.height_px = 3;
  for (int i = 0; i < 6; ++i)
    for (const int value : {40 * i, 255 - 40 * i, 7, 255})
      picture.rgba.push_back(static_cast<std::uint8_t>(value));
  model.pictures.push_back(picture);
  AvatarMaterial& cloth = model.materials[0];
  cloth.picture = 0;
  cloth.shading = Shading::kToon;
  cloth.shade_colour = {0.25f, 0.5f, 0.75f};
  cloth.shade_shift = -0.25f;
  cloth.is_double_sided = true;
  model.materials[1].shading = Shading::kUnlit;
  model.materials[2].alpha_mode = AlphaMode::kMask;
  model.materials[2].alpha_cutoff = 0.25f;
  const std::uint32_t vertex = model.triangles[model.parts[1].first_index];
  AvatarMorph morph;
  morph.name = "grin";
  morph.vertices = {vertex, vertex + 2};
  morph.places_m = {{0.01f, 0, 0}, {0, 0.02f, 0}};
  model.morphs.push_back(morph);
  model.expressions.push_back({"happy", {{0, 0.75f}}});
  model.expressions.push_back({"proud", {{0, 1.0f}}});
  AvatarNode lock;
  lock.name = "lock";
  lock.parent = model.node_of(Bone::kHead);
  lock.translation_m = {0, 0.1f, -0.1f};
  model.nodes.push_back(lock);
  AvatarSpring spring;
  spring.joints.push_back({static_cast<int>(model.nodes.size()) - 1,
                           {0, -0.2f, 0},
                           0.02f,
                           0.5f,
                           0.1f,
                           -Vector3f::UnitY(),
                           0.3f});
  model.colliders.push_back({model.node_of(Bone::kHead), {0, 0.1f, 0}, {0, 0.1f, 0}, 0.1f});
  model.colliders.push_back({model.node_of(Bone::kUpperChest), {0, 0, 0}, {0, 0.1f, 0}, 0.12f});
  spring.colliders = {0, 1};
  model.springs.push_back(spring);
  return model;
}

std::vector<Affine3f> rest_of(const AvatarModel& model) {
  std::vector<Affine3f> rest;
  for (const AvatarNode& node : model.nodes) {
    Affine3f local = Affine3f::Identity();
    local.translate(node.translation_m).rotate(node.rotation).scale(node.scale);
    rest.push_back(node.parent < 0 ? local : rest[static_cast<std::size_t>(node.parent)] * local);
  }
  return rest;
}

// Every corner of every triangle at rest, part by part, in the order of the parts' materials.
std::map<std::string, std::vector<Vector3f>> corners_of(const AvatarModel& model) {
  const std::vector<Affine3f> rest = rest_of(model);
  std::map<std::string, std::vector<Vector3f>> corners;
  for (const AvatarPart& part : model.parts)
    for (std::uint32_t i = 0; i < part.index_count; ++i) {
      const AvatarVertex& vertex = model.vertices[model.triangles[part.first_index + i]];
      Vector3f place = Vector3f::Zero();
      for (std::size_t k = 0; k < 4; ++k) {
        const AvatarJoint& joint = model.joints[vertex.joints[k]];
        place +=
            static_cast<float>(vertex.weights[k]) / 255.0f *
            (rest[static_cast<std::size_t>(joint.node)] * (joint.node_from_mesh * vertex.place_m));
      }
      corners[model.materials[part.material].name].push_back(place);
    }
  return corners;
}

void expect_same_surface(const AvatarModel& known, const AvatarModel& read) {
  const auto a = corners_of(known);
  const auto b = corners_of(read);
  ASSERT_EQ(a.size(), b.size());
  for (const auto& [material, corners] : a) {
    ASSERT_TRUE(b.contains(material)) << material;
    ASSERT_EQ(b.at(material).size(), corners.size()) << material;
    for (std::size_t i = 0; i < corners.size(); ++i)
      ASSERT_LT((b.at(material)[i] - corners[i]).norm(), 1e-5f) << material << " " << i;
  }
}

TEST(VrmWriter, OurReaderGivesTheFigureBack) {
  const AvatarModel model = dressed();
  const auto file = write_vrm(model, meta());
  ASSERT_TRUE(file) << file.error().what;
  const auto read = read_avatar(*file);
  ASSERT_TRUE(read) << read.error().what;
  expect_same_surface(model, read->model);
  const auto known = rest_of(model);
  const auto found = rest_of(read->model);
  for (std::size_t b = 0; b < kBoneCount; ++b) {
    ASSERT_GE(read->model.bones[b], 0) << kBones[b].name;
    EXPECT_LT((found[static_cast<std::size_t>(read->model.bones[b])].translation() -
               known[static_cast<std::size_t>(model.bones[b])].translation())
                  .norm(),
              1e-5f);
  }
  for (const int finger : read->model.fingers) EXPECT_GE(finger, 0);
  ASSERT_EQ(read->model.pictures.size(), 1u);
  EXPECT_EQ(read->model.pictures[0].rgba, model.pictures[0].rgba);
  ASSERT_EQ(read->model.materials.size(), model.materials.size());
  for (std::size_t m = 0; m < model.materials.size(); ++m) {
    const AvatarMaterial& was = model.materials[m];
    const AvatarMaterial& is = read->model.materials[m];
    EXPECT_EQ(is.name, was.name);
    EXPECT_TRUE(is.base_colour.isApprox(was.base_colour, 1e-5f));
    EXPECT_EQ(is.shading, was.shading);
    EXPECT_EQ(is.alpha_mode, was.alpha_mode);
    EXPECT_EQ(is.is_double_sided, was.is_double_sided);
    EXPECT_EQ(is.picture, was.picture);
  }
}

std::string node_name(const AvatarModel& model, int node) {
  return node < 0 ? "none" : model.nodes.at(static_cast<std::size_t>(node)).name;
}

// Where the vertices of a morph are at rest in their mesh's axes, and by how much they move.
std::vector<std::array<float, 6>> moves_of(const AvatarModel& model, const AvatarMorph& morph) {
  std::vector<std::array<float, 6>> moves;
  for (std::size_t i = 0; i < morph.vertices.size(); ++i) {
    const AvatarVertex& vertex = model.vertices[morph.vertices[i]];
    const AvatarJoint& joint = model.joints[vertex.joints[0]];
    const Affine3f M_from_mesh =
        rest_of(model)[static_cast<std::size_t>(joint.node)] * joint.node_from_mesh;
    const Vector3f place = M_from_mesh * vertex.place_m;
    const Vector3f move = M_from_mesh.linear() * morph.places_m[i];
    moves.push_back({place.x(), place.y(), place.z(), move.x(), move.y(), move.z()});
  }
  std::ranges::sort(moves);
  return moves;
}

void expect_same_spring(const AvatarModel& known, const AvatarModel& read) {
  ASSERT_EQ(read.springs.size(), 1u);
  const AvatarSpring& was = known.springs[0];
  const AvatarSpring& is = read.springs[0];
  EXPECT_EQ(node_name(read, is.centre), node_name(known, was.centre));
  ASSERT_EQ(is.joints.size(), was.joints.size());
  for (std::size_t j = 0; j < was.joints.size(); ++j) {
    EXPECT_EQ(node_name(read, is.joints[j].node), node_name(known, was.joints[j].node));
    EXPECT_LT((is.joints[j].tail_m - was.joints[j].tail_m).norm(), 1e-5f);
    EXPECT_NEAR(is.joints[j].radius_m, was.joints[j].radius_m, 1e-6f);
    EXPECT_NEAR(is.joints[j].stiffness, was.joints[j].stiffness, 1e-6f);
    EXPECT_NEAR(is.joints[j].gravity, was.joints[j].gravity, 1e-6f);
    EXPECT_TRUE(is.joints[j].gravity_direction.isApprox(was.joints[j].gravity_direction, 1e-5f));
    EXPECT_NEAR(is.joints[j].drag, was.joints[j].drag, 1e-6f);
  }
  ASSERT_EQ(is.colliders.size(), was.colliders.size());
  for (std::size_t c = 0; c < was.colliders.size(); ++c) {
    const AvatarCollider& a = known.colliders[was.colliders[c]];
    const AvatarCollider& b = read.colliders[is.colliders[c]];
    EXPECT_EQ(node_name(read, b.node), node_name(known, a.node));
    EXPECT_LT((b.centre_m - a.centre_m).norm(), 1e-5f);
    EXPECT_LT((b.tail_m - a.tail_m).norm(), 1e-5f);
    EXPECT_NEAR(b.radius_m, a.radius_m, 1e-6f);
  }
}

TEST(VrmWriter, OurReaderGivesMorphsExpressionsAndSpringsBack) {
  AvatarModel model = dressed();
  model.springs[0].centre = model.node_of(Bone::kHips);
  const auto file = write_vrm(model, meta());
  ASSERT_TRUE(file) << file.error().what;
  const auto found = read_avatar(*file);
  ASSERT_TRUE(found) << found.error().what;
  EXPECT_TRUE(found->notes.empty()) << found->notes.front();
  const AvatarModel& read = found->model;
  EXPECT_EQ(read.name, model.name);
  ASSERT_EQ(read.morphs.size(), 1u);
  EXPECT_EQ(read.morphs[0].name, "grin");
  const auto was = moves_of(model, model.morphs[0]);
  const auto is = moves_of(read, read.morphs[0]);
  ASSERT_EQ(is.size(), was.size());
  for (std::size_t i = 0; i < was.size(); ++i)
    for (std::size_t k = 0; k < 6; ++k) EXPECT_NEAR(is[i][k], was[i][k], 1e-5f);
  ASSERT_EQ(read.expressions.size(), model.expressions.size());
  for (std::size_t e = 0; e < model.expressions.size(); ++e) {
    EXPECT_EQ(read.expressions[e].name, model.expressions[e].name);
    ASSERT_EQ(read.expressions[e].binds.size(), 1u);
    EXPECT_EQ(read.expressions[e].binds[0].morph, model.expressions[e].binds[0].morph);
    EXPECT_NEAR(read.expressions[e].binds[0].weight, model.expressions[e].binds[0].weight, 1e-6f);
  }
  expect_same_spring(model, read);
}

// What was read once is written and read without any change.
TEST(VrmWriter, ASecondRoundChangesNothing) {
  const auto first = read_avatar(*write_vrm(dressed(), meta()));
  ASSERT_TRUE(first) << first.error().what;
  const auto second = read_avatar(*write_vrm(first->model, meta()));
  ASSERT_TRUE(second) << second.error().what;
  expect_same_surface(first->model, second->model);
  expect_same_spring(first->model, second->model);
  EXPECT_EQ(second->model.vertices.size(), first->model.vertices.size());
  EXPECT_EQ(second->model.pictures[0].rgba, first->model.pictures[0].rgba);
  EXPECT_EQ(second->model.morphs[0].vertices.size(), first->model.morphs[0].vertices.size());
}

TEST(VrmWriter, SaysWhoMadeItAndWhoMayUseIt) {
  VrmMeta wanted = meta();
  wanted.name = "clara";
  wanted.needs_credit = true;
  wanted.allows_commercial_use = false;
  const auto file = write_vrm(dressed(), wanted);
  ASSERT_TRUE(file);
  const json is = test::glb_json(*file)["extensions"]["VRMC_vrm"];
  EXPECT_EQ(is["specVersion"], "1.0");
  EXPECT_EQ(is["meta"]["name"], "clara");
  EXPECT_EQ(is["meta"]["authors"], (json{"a tailor", "a hairdresser"}));
  EXPECT_EQ(is["meta"]["licenseUrl"], "https://vrm.dev/licenses/1.0/");
  EXPECT_EQ(is["meta"]["otherLicenseUrl"], "https://example.org/licence");
  EXPECT_EQ(is["meta"]["creditNotation"], "required");
  EXPECT_EQ(is["meta"]["commercialUsage"], "personalNonProfit");
  EXPECT_EQ(is["meta"]["allowRedistribution"], true);
}

TEST(VrmWriter, ExpressionsSpringsAndToonAreInTheExtensions) {
  const auto file = write_vrm(dressed(), meta());
  ASSERT_TRUE(file);
  const json gltf = test::glb_json(*file);
  const json& vrm = gltf["extensions"]["VRMC_vrm"];
  const json& bind = vrm["expressions"]["preset"]["happy"]["morphTargetBinds"][0];
  EXPECT_EQ(bind["weight"], 0.75);
  const auto mesh = gltf["nodes"][bind["node"].get<std::size_t>()]["mesh"].get<std::size_t>();
  EXPECT_EQ(gltf["meshes"][mesh]["extras"]["targetNames"][0], "grin");
  const json& target = gltf["meshes"][mesh]["primitives"][0]["targets"][0];
  EXPECT_EQ(gltf["accessors"][target["POSITION"].get<std::size_t>()]["sparse"]["count"], 2);
  // One that VRM does not know is a custom one.
  EXPECT_TRUE(vrm["expressions"]["custom"].contains("proud"));
  const json& swings = gltf["extensions"]["VRMC_springBone"];
  ASSERT_EQ(swings["springs"].size(), 1u);
  // The joint that swings, and a node for its end, which the model did not have.
  const json& joints = swings["springs"][0]["joints"];
  ASSERT_EQ(joints.size(), 2u);
  EXPECT_EQ(gltf["nodes"][joints[0]["node"].get<std::size_t>()]["name"], "lock");
  EXPECT_EQ(gltf["nodes"][joints[1]["node"].get<std::size_t>()]["name"], "lockEnd");
  EXPECT_EQ(joints[0]["stiffness"], 0.5);
  EXPECT_EQ(joints[0]["hitRadius"], 0.02);
  EXPECT_TRUE(swings["colliders"][0]["shape"].contains("sphere"));
  EXPECT_TRUE(swings["colliders"][1]["shape"].contains("capsule"));
  EXPECT_EQ(swings["colliderGroups"][0]["colliders"], (json{0, 1}));
  const json& toon = gltf["materials"][0]["extensions"]["VRMC_materials_mtoon"];
  EXPECT_EQ(toon["shadeColorFactor"], (json{0.25, 0.5, 0.75}));
  EXPECT_EQ(toon["shadingShiftFactor"], -0.25);
  EXPECT_TRUE(gltf["materials"][1]["extensions"].contains("KHR_materials_unlit"));
}

// A file with several skins reads as several joints of one node.
TEST(VrmWriter, TwoJointsOfOneNodeLeaveTheSurfaceWhereItIs) {
  AvatarModel model = dressed();
  AvatarJoint second = model.joints[index_of(Bone::kHips)];
  const Affine3f moved(Eigen::Translation3f(0.5f, 0.25f, 0));
  second.node_from_mesh = second.node_from_mesh * moved.inverse();
  model.joints.push_back(second);
  const auto hips = static_cast<std::uint16_t>(index_of(Bone::kHips));
  std::size_t changed = 0;
  for (AvatarVertex& vertex : model.vertices) {
    if (vertex.joints[0] != hips || vertex.weights[0] != 255) continue;
    vertex.joints[0] = static_cast<std::uint16_t>(model.joints.size() - 1);
    vertex.place_m = moved * vertex.place_m;
    ++changed;
  }
  ASSERT_GT(changed, 20u);
  const auto file = write_vrm(model, meta());
  ASSERT_TRUE(file) << file.error().what;
  const json gltf = test::glb_json(*file);
  EXPECT_EQ(gltf["skins"][0]["joints"].size(), model.joints.size() - 1);
  const auto read = read_avatar(*file);
  ASSERT_TRUE(read) << read.error().what;
  expect_same_surface(model, read->model);
}

TEST(VrmWriter, RefusesWhatVrmDoesNotAllowAndSaysWhy) {
  const AvatarModel model = dressed();
  EXPECT_NE(write_vrm(model, {}).error().what.find("author"), std::string::npos);
  AvatarModel spineless = model;
  spineless.bones[index_of(Bone::kSpine)] = -1;
  EXPECT_NE(write_vrm(spineless, meta()).error().what.find("spine"), std::string::npos);
  AvatarModel unsound = model;
  unsound.triangles[0] = static_cast<std::uint32_t>(model.vertices.size());
  EXPECT_FALSE(write_vrm(unsound, meta()));
  AvatarModel nameless = model;
  nameless.name.clear();
  EXPECT_NE(write_vrm(nameless, meta()).error().what.find("name"), std::string::npos);
  AvatarModel empty = model;
  empty.triangles.clear();
  empty.parts.clear();
  EXPECT_NE(write_vrm(empty, meta()).error().what.find("surface"), std::string::npos);
}

}  // namespace
}  // namespace dance
