// Meshes as exporters write them: each way of storing them gives the same square.
#include <gtest/gtest.h>

#include <cmath>

#include "formats/avatar/read/mesh/avatar_vertices.h"
#include "tests/formats/avatar/read_well.h"

namespace dance {
namespace {

using test::Bytes;
using test::model_of;
using test::TinyAvatar;

// The corners that the triangles name, one after the other, and what each vertex is worth.
std::vector<Eigen::Vector3f> corners(const AvatarModel& model) {
  std::vector<Eigen::Vector3f> places;
  for (const std::uint32_t vertex : model.triangles)
    places.push_back(model.vertices[vertex].place_m);
  return places;
}

std::vector<Eigen::Vector3f> square_corners() {
  const Eigen::Vector3f a(-0.1f, 0.9f, 0), b(0.1f, 0.9f, 0), c(0.1f, 1.1f, 0), d(-0.1f, 1.1f, 0);
  return {a, b, c, a, c, d};
}

void expect_near(const std::vector<Eigen::Vector3f>& is, const std::vector<Eigen::Vector3f>& want,
                 float within) {
  ASSERT_EQ(is.size(), want.size());
  for (std::size_t i = 0; i < is.size(); ++i)
    EXPECT_LT((is[i] - want[i]).norm(), within) << i << ": " << is[i].transpose();
}

TEST(AvatarMesh, ASquareIsReadAsItWasWritten) {
  TinyAvatar avatar;
  avatar.add_mesh(avatar.square());
  for (const Bytes& bytes : {avatar.glb(), avatar.gltf()}) {
    const auto read = read_avatar(bytes);
    ASSERT_TRUE(read) << read.error().what;
    expect_near(corners(read->model), square_corners(), 1e-7f);
    ASSERT_EQ(read->model.vertices.size(), 4u);
    const AvatarVertex& vertex = read->model.vertices[1];
    EXPECT_EQ(vertex.normal, Eigen::Vector3f(0, 0, 1));
    EXPECT_EQ(vertex.uv, Eigen::Vector2f(1, 1));
    const AvatarJoint& joint = read->model.joints[vertex.joints[0]];
    EXPECT_EQ(joint.node, read->model.node_of(Bone::kHips));
    EXPECT_EQ(joint.node_from_mesh.translation(), Eigen::Vector3f(0, -1, 0));
  }
}

TEST(AvatarMesh, IndicesOfAllSizesStripsFansAndNoIndicesAreTheSame) {
  const auto with = [](const std::function<void(TinyAvatar&, nlohmann::json&)>& change) {
    TinyAvatar avatar;
    nlohmann::json primitive = avatar.square();
    change(avatar, primitive);
    avatar.add_mesh(primitive);
    return corners(model_of(avatar));
  };
  const auto square = square_corners();
  expect_near(with([](TinyAvatar& a, auto& p) {
                p["indices"] = a.add_integers<std::uint8_t>({0, 1, 2, 0, 2, 3}, "SCALAR");
              }),
              square, 1e-7f);
  expect_near(with([](TinyAvatar& a, auto& p) {
                p["indices"] = a.add_integers<std::uint32_t>({0, 1, 2, 0, 2, 3}, "SCALAR");
              }),
              square, 1e-7f);
  expect_near(with([](TinyAvatar&, auto& p) {
                p["mode"] = 6;
                p.erase("indices");
              }),
              square, 1e-7f);
  const auto strip = with([](TinyAvatar& a, auto& p) {
    p["mode"] = 5;
    p["indices"] = a.add_integers<std::uint16_t>({0, 1, 3, 2, 2, 2}, "SCALAR");
  });
  expect_near(strip, {square[0], square[1], square[5], square[1], square[2], square[5]}, 1e-7f);
  const auto list = with([](TinyAvatar& a, auto& p) {
    p.erase("indices");
    const auto& at = square_corners();
    std::vector<float> places;
    for (const auto& corner : at) places.insert(places.end(), corner.data(), corner.data() + 3);
    p["attributes"] = {{"POSITION", a.add_floats(places, "VEC3")}};
  });
  expect_near(list, square, 1e-7f);
}

TEST(AvatarMesh, PointsAndLinesAreLeftOutWithANote) {
  TinyAvatar avatar;
  nlohmann::json lines = avatar.square();
  lines["mode"] = 1;
  avatar.add_mesh({avatar.square(), lines});
  std::vector<std::string> notes;
  EXPECT_EQ(model_of(avatar, &notes).triangles.size(), 6u);
  ASSERT_EQ(notes.size(), 1u);
  EXPECT_NE(notes[0].find("lines"), std::string::npos);
}

TEST(AvatarMesh, InterleavedAndSparseAccessorsAreUnderstood) {
  TinyAvatar avatar;
  nlohmann::json primitive = avatar.square();
  // Place and normal of each vertex side by side, all with z = 5; then two of them replaced.
  std::vector<float> mixed;
  const Eigen::Vector3f at[] = {{-0.1f, 0.9f, 0}, {0.1f, 0.9f, 0}, {9, 9, 9}, {8, 8, 8}};
  for (const Eigen::Vector3f& place : at)
    mixed.insert(mixed.end(), {place.x(), place.y(), place.z(), 0, 0, 1});
  const auto* bytes = reinterpret_cast<const std::uint8_t*>(mixed.data());
  const int view = avatar.add_view({bytes, mixed.size() * 4}, 24);
  const int places = avatar.add_accessor(view, 5126, "VEC3", 4);
  primitive["attributes"]["POSITION"] = places;
  primitive["attributes"]["NORMAL"] = avatar.add_accessor(view, 5126, "VEC3", 4, 12);
  const std::uint16_t which[] = {2, 3};
  const float instead[] = {0.1f, 1.1f, 0, -0.1f, 1.1f, 0};
  const int indices = avatar.add_view({reinterpret_cast<const std::uint8_t*>(which), 4});
  const int values = avatar.add_view({reinterpret_cast<const std::uint8_t*>(instead), 24});
  avatar.json["accessors"][static_cast<std::size_t>(places)]["sparse"] = {
      {"count", 2},
      {"indices", {{"bufferView", indices}, {"componentType", 5123}}},
      {"values", {{"bufferView", values}}}};
  avatar.add_mesh(primitive);
  const AvatarModel model = model_of(avatar);
  expect_near(corners(model), square_corners(), 1e-7f);
  EXPECT_EQ(model.vertices[3].normal, Eigen::Vector3f(0, 0, 1));
}

TEST(AvatarMesh, QuantizedMeshesKeepTheirScaleInTheJoints) {
  TinyAvatar avatar;
  nlohmann::json primitive = avatar.square();
  // Shorts of -32767..32767 stand for -1..1, normals as bytes, uv as bytes.
  const auto q = [](float v) {
    return static_cast<std::uint16_t>(std::lround(v / 2.0f * 32767.0f));
  };
  std::vector<std::uint16_t> places;
  for (const auto& [x, y] : {std::pair(-0.1f, 0.9f), {0.1f, 0.9f}, {0.1f, 1.1f}, {-0.1f, 1.1f}})
    places.insert(places.end(), {q(x), q(y), 0, 0});
  const int view =
      avatar.add_view({reinterpret_cast<const std::uint8_t*>(places.data()), places.size() * 2}, 8);
  primitive["attributes"]["POSITION"] = avatar.add_accessor(view, 5122, "VEC3", 4, 0, true);
  const Bytes normals{0, 0, 127, 0, 0, 0, 127, 0, 0, 0, 127, 0, 0, 0, 127, 0};
  primitive["attributes"]["NORMAL"] =
      avatar.add_accessor(avatar.add_view(normals, 4), 5120, "VEC3", 4, 0, true);
  const Bytes uv{0, 255, 0, 0, 255, 255, 0, 0, 255, 0, 0, 0, 0, 0, 0, 0};
  primitive["attributes"]["TEXCOORD_0"] =
      avatar.add_accessor(avatar.add_view(uv, 4), 5121, "VEC2", 4, 0, true);
  avatar.json["extensionsUsed"] = {"KHR_mesh_quantization"};
  avatar.json["extensionsRequired"] = {"KHR_mesh_quantization"};
  const std::vector<float> twice{2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 2, 0, 0, -1, 0, 1};
  const int matrix = avatar.add_floats(twice, "MAT4");
  avatar.json["skins"] = {{{"joints", {0}}, {"inverseBindMatrices", matrix}}};
  avatar.add_mesh(primitive);
  const AvatarModel model = model_of(avatar);
  ASSERT_EQ(model.vertices.size(), 4u);
  const AvatarJoint& joint = model.joints[model.vertices[2].joints[0]];
  const Eigen::Vector3f at_hips = joint.node_from_mesh * model.vertices[2].place_m;
  EXPECT_LT((at_hips - Eigen::Vector3f(0.1f, 0.1f, 0.0f)).norm(), 1e-4f);
  EXPECT_EQ(model.vertices[2].normal, Eigen::Vector3f(0, 0, 1));
  EXPECT_EQ(model.vertices[1].uv, Eigen::Vector2f(1, 1));
}

TEST(AvatarMesh, OfEightInfluencesTheFourLargestStay) {
  const std::array<std::uint16_t, 8> joints{0, 1, 2, 3, 4, 5, 6, 7};
  const std::array<float, 8> weights{0.05f, 0.3f, 0.05f, 0.2f, 0.1f, 0.05f, 0.2f, 0.05f};
  const FourWeights four = four_largest(joints, weights);
  EXPECT_EQ(four.joints, (std::array<std::uint16_t, 4>{1, 3, 6, 4}));
  EXPECT_EQ(four.weights, (std::array<std::uint8_t, 4>{95, 64, 64, 32}));
  const std::array<float, 8> none{};
  EXPECT_EQ(four_largest(joints, none).weights[0], 255);
  for (int seed = 0; seed < 1000; ++seed) {
    std::array<float, 8> any{};
    for (std::size_t k = 0; k < 8; ++k)
      any[k] = std::abs(std::sin(static_cast<float>(seed * 8) + static_cast<float>(k) * 1.7f));
    int sum = 0;
    for (const auto weight : four_largest(joints, any).weights) sum += weight;
    EXPECT_EQ(sum, 255);
  }
}

TEST(AvatarMesh, TwoSetsOfJointsAreReadTogether) {
  TinyAvatar avatar;
  nlohmann::json primitive = avatar.square();
  const int head = avatar.node("head");
  Bytes joints(16, 0);
  for (std::size_t v = 0; v < 4; ++v) joints[4 * v] = static_cast<std::uint8_t>(head);
  primitive["attributes"]["JOINTS_1"] = avatar.add_integers<std::uint8_t>(joints, "VEC4");
  primitive["attributes"]["WEIGHTS_1"] = avatar.add_integers<std::uint8_t>(
      {255, 0, 0, 0, 255, 0, 0, 0, 0, 0, 0, 0, 85, 0, 0, 0}, "VEC4", true);
  avatar.add_mesh(primitive);
  const AvatarModel model = model_of(avatar);
  ASSERT_EQ(model.vertices.size(), 4u);
  const auto weight_at = [&](std::size_t v, Bone bone) {
    int sum = 0;
    for (std::size_t k = 0; k < 4; ++k)
      if (model.joints[model.vertices[v].joints[k]].node == model.node_of(bone))
        sum += model.vertices[v].weights[k];
    return sum;
  };
  EXPECT_EQ(weight_at(0, Bone::kHips), 127);
  EXPECT_EQ(weight_at(0, Bone::kHead), 128);
  EXPECT_EQ(weight_at(2, Bone::kHips), 255);
  EXPECT_EQ(weight_at(3, Bone::kHead), 64);
}

TEST(AvatarMesh, ASkinWithoutMatricesHasThemAsIdentity) {
  TinyAvatar avatar;
  avatar.json["skins"] = {{{"joints", {avatar.node("hips")}}}};
  avatar.add_mesh(avatar.square());
  const AvatarModel model = model_of(avatar);
  ASSERT_EQ(model.joints.size(), 1u);
  EXPECT_TRUE(model.joints[0].node_from_mesh.isApprox(Eigen::Affine3f::Identity()));
}

TEST(AvatarMesh, SeveralSkinsShareTheJointsThatAreTheSame) {
  TinyAvatar avatar;
  avatar.add_mesh(avatar.square());
  const std::size_t joints = model_of(avatar).joints.size();
  const int again = avatar.add_mesh(avatar.square());
  avatar.json["skins"].push_back(avatar.json["skins"][0]);
  avatar.json["nodes"][static_cast<std::size_t>(again)]["skin"] = 1;
  EXPECT_EQ(model_of(avatar).joints.size(), joints);
  EXPECT_EQ(model_of(avatar).vertices.size(), 8u);
  // Another place of the mesh at the joint is another joint.
  avatar.json["skins"][1].erase("inverseBindMatrices");
  EXPECT_EQ(model_of(avatar).joints.size(), 2 * joints);
}

TEST(AvatarMesh, PrimitivesWithTheSameVerticesShareThem) {
  TinyAvatar avatar;
  const nlohmann::json square = avatar.square();
  avatar.json["materials"] = {{{"name", "a"}}, {{"name", "b"}}};
  nlohmann::json a = square, b = square, c = square;
  a["material"] = 0;
  b["material"] = 1;
  c["material"] = 0;
  avatar.add_mesh({a, b, c});
  const AvatarModel model = model_of(avatar);
  EXPECT_EQ(model.vertices.size(), 4u);
  ASSERT_EQ(model.parts.size(), 2u);  // those of one material are one
  EXPECT_EQ(model.parts[0].index_count, 12u);
  EXPECT_EQ(model.parts[1].first_index, 12u);
}

TEST(AvatarMesh, AMeshWithoutASkinFollowsItsNode) {
  TinyAvatar avatar;
  nlohmann::json hat = avatar.square();
  const int node = avatar.add_mesh(hat, false, avatar.node("head"));
  AvatarModel model = model_of(avatar);
  ASSERT_EQ(model.joints.size(), 1u);
  EXPECT_EQ(model.nodes[static_cast<std::size_t>(model.joints[0].node)].name, "mesh");
  expect_near(corners(model), square_corners(), 1e-7f);
  // Mirrored, its triangles are turned over.
  avatar.json["nodes"][static_cast<std::size_t>(node)]["scale"] = {-1, 1, 1};
  const auto mirrored = corners(model_of(avatar));
  const auto square = square_corners();
  expect_near(mirrored, {square[0], square[2], square[1], square[0], square[5], square[2]}, 1e-7f);
}

TEST(AvatarMesh, WhatDoesNotFollowTheFigureOrIsNotInItsSceneIsLeftOut) {
  TinyAvatar avatar;
  avatar.add_mesh(avatar.square());
  avatar.add_mesh(avatar.square(), false);  // a floor
  std::vector<std::string> notes;
  EXPECT_EQ(model_of(avatar, &notes).vertices.size(), 4u);
  EXPECT_EQ(notes.size(), 1u);
  const int other = avatar.add_mesh(avatar.square());
  EXPECT_EQ(model_of(avatar).vertices.size(), 8u);
  avatar.json["scenes"] = {{{"nodes", {0, other - 2}}}, {{"nodes", {other}}}};
  EXPECT_EQ(model_of(avatar).vertices.size(), 4u);
}

TEST(AvatarMesh, MissingNormalsAreMadeAndMissingUvAreZero) {
  TinyAvatar avatar;
  nlohmann::json primitive = avatar.square();
  primitive["attributes"].erase("NORMAL");
  primitive["attributes"].erase("TEXCOORD_0");
  avatar.add_mesh(primitive);
  const AvatarModel model = model_of(avatar);
  for (const AvatarVertex& vertex : model.vertices) {
    EXPECT_LT((vertex.normal - Eigen::Vector3f(0, 0, 1)).norm(), 1e-6f);
    EXPECT_EQ(vertex.uv, Eigen::Vector2f(0, 0));
  }
}

TEST(AvatarMesh, MorphsKeepTheVerticesThatMove) {
  TinyAvatar avatar;
  nlohmann::json primitive = avatar.square();
  const int smile = avatar.add_floats({0, 0, 0, 0, 0.01f, 0, 0, 0, 0, 0, 0, 0}, "VEC3");
  const int normals = avatar.add_floats({0, 0, 0, 0, 0, 0, 0, 0, 0, 0.1f, 0, 0}, "VEC3");
  // All zeros but one, without a view: as morphs are often written.
  const int frown = avatar.add_accessor(-1, 5126, "VEC3", 4);
  const std::uint8_t which[] = {3};
  const float move[] = {0, -0.02f, 0};
  const int indices = avatar.add_view(which);
  const int values = avatar.add_view({reinterpret_cast<const std::uint8_t*>(move), 12});
  avatar.json["accessors"][static_cast<std::size_t>(frown)]["sparse"] = {
      {"count", 1},
      {"indices", {{"bufferView", indices}, {"componentType", 5121}}},
      {"values", {{"bufferView", values}}}};
  primitive["targets"] = {{{"POSITION", smile}, {"NORMAL", normals}}, {{"POSITION", frown}}};
  avatar.add_mesh(primitive);
  avatar.json["meshes"][0]["extras"]["targetNames"] = {"smile", "frown\x1b[2J"};
  const AvatarModel model = model_of(avatar);
  ASSERT_EQ(model.morphs.size(), 2u);
  EXPECT_EQ(model.morphs[0].name, "smile");
  EXPECT_EQ(model.morphs[0].vertices, (std::vector<std::uint32_t>{1, 3}));
  EXPECT_EQ(model.morphs[0].places_m[0], Eigen::Vector3f(0, 0.01f, 0));
  EXPECT_EQ(model.morphs[0].normals[1], Eigen::Vector3f(0.1f, 0, 0));
  EXPECT_EQ(model.morphs[1].name, "frown?[2J");
  EXPECT_EQ(model.morphs[1].vertices, (std::vector<std::uint32_t>{3}));
  EXPECT_TRUE(model.morphs[1].normals.empty());
}

}  // namespace
}  // namespace dance
