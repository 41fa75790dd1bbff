// What makes a figure live: expressions, springs, and what its file tells of itself.
#include <gtest/gtest.h>

#include "tests/formats/avatar/read_well.h"

namespace dance {
namespace {

using nlohmann::json;
using test::model_of;
using test::name_of_node;
using test::TinyAvatar;

// A face with these targets, each of which moves one vertex.
TinyAvatar with_targets(const std::vector<std::string>& names, int& node, bool faces_back = false) {
  TinyAvatar avatar({}, faces_back);
  json primitive = avatar.square();
  for (std::size_t t = 0; t < names.size(); ++t)
    primitive["targets"].push_back(
        {{"POSITION", avatar.add_floats({0.01f, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}, "VEC3")}});
  node = avatar.add_mesh(primitive);
  avatar.json["meshes"][0]["extras"]["targetNames"] = names;
  return avatar;
}

const AvatarExpression* find(const AvatarModel& model, const std::string& name) {
  for (const AvatarExpression& expression : model.expressions)
    if (expression.name == name) return &expression;
  return nullptr;
}

TEST(AvatarLife, ExpressionsOfVrm1NameMorphsByTheirNode) {
  int node = 0;
  TinyAvatar avatar = with_targets({"a", "b"}, node);
  auto& expressions = avatar.json["extensions"]["VRMC_vrm"]["expressions"];
  expressions["preset"]["happy"]["morphTargetBinds"] = {
      {{"node", node}, {"index", 1}, {"weight", 0.5}},
      {{"node", node}, {"index", 2}, {"weight", 1.0}},   // no such target
      {{"node", 9999}, {"index", 0}, {"weight", 1.0}}};  // no such node
  expressions["custom"]["my\x07wink"]["morphTargetBinds"] = {
      {{"node", node}, {"index", 0}, {"weight", 7.0}}};
  const AvatarModel model = model_of(avatar);
  ASSERT_EQ(model.expressions.size(), 2u);
  const AvatarExpression* happy = find(model, "happy");
  ASSERT_TRUE(happy);
  ASSERT_EQ(happy->binds.size(), 1u);
  EXPECT_EQ(model.morphs[happy->binds[0].morph].name, "b");
  EXPECT_FLOAT_EQ(happy->binds[0].weight, 0.5f);
  const AvatarExpression* wink = find(model, "my?wink");
  ASSERT_TRUE(wink);
  EXPECT_FLOAT_EQ(wink->binds[0].weight, 1.0f);
}

TEST(AvatarLife, ExpressionsOfVrm0GetTheNamesOfVrm1) {
  int node = 0;
  TinyAvatar avatar = with_targets({"a"}, node);
  auto& groups = avatar.json["extensions"]["VRM"]["blendShapeMaster"]["blendShapeGroups"];
  for (const auto& [name, preset] : {std::pair("Joy", "joy"),
                                     {"Sorrow", "sorrow"},
                                     {"FUN", "fun"},
                                     {"A", "a"},
                                     {"I", "i"},
                                     {"Blink_L", "blink_l"},
                                     {"Surprised", "unknown"},
                                     {"Ears", "unknown"}})
    groups.push_back({{"name", name},
                      {"presetName", preset},
                      {"binds", {{{"mesh", 0}, {"index", 0}, {"weight", 40}}}}});
  const AvatarModel model = model_of(avatar);
  for (const char* name :
       {"happy", "sad", "relaxed", "aa", "ih", "blinkLeft", "surprised", "Ears"}) {
    const AvatarExpression* expression = find(model, name);
    ASSERT_TRUE(expression) << name;
    EXPECT_FLOAT_EQ(expression->binds.at(0).weight, 0.4f);
  }
  EXPECT_EQ(model.expressions.size(), 8u);
}

TEST(AvatarLife, AFaceMadeForArkitBlinks) {
  int node = 0;
  const AvatarModel model = model_of(with_targets({"jawOpen", "eyeBlinkLeft", "eyeBlink_R"}, node));
  EXPECT_EQ(model.morphs.size(), 3u);
  ASSERT_EQ(model.expressions.size(), 3u);
  EXPECT_EQ(find(model, "blink")->binds.size(), 2u);
  EXPECT_EQ(find(model, "blinkLeft")->binds[0].morph, 1u);
  EXPECT_EQ(find(model, "blinkRight")->binds[0].morph, 2u);
}

// Hair of three joints behind the head, 10 cm each.
std::array<int, 3> add_hair(TinyAvatar& avatar) {
  std::array<int, 3> hair{};
  int above = avatar.node("head");
  for (std::size_t h = 0; h < 3; ++h)
    hair[h] = above = avatar.add_node("hair" + std::to_string(h), above,
                                      {0, 1.6f - 0.1f * static_cast<float>(h), -0.1f});
  return hair;
}

TEST(AvatarLife, SpringsOfVrm1AreChainsWithCollidersInGroups) {
  TinyAvatar avatar;
  const auto hair = add_hair(avatar);
  avatar.add_mesh(avatar.square());
  auto& springs = avatar.json["extensions"]["VRMC_springBone"];
  const int chest = avatar.node("chest");
  springs["colliders"] = {
      {{"node", chest}, {"shape", {{"sphere", {{"offset", {0, 0.1, 0}}, {"radius", 0.2}}}}}},
      {{"node", chest},
       {"shape", {{"capsule", {{"offset", {0, 0, 0}}, {"tail", {0, 0.3, 0}}, {"radius", 0.1}}}}}},
      {{"node", 777}, {"shape", {{"sphere", {{"radius", 1}}}}}}};
  springs["colliderGroups"] = {{{"colliders", {0}}}, {{"colliders", {1, 1, 2, 99}}}};
  springs["springs"] = {{{"center", avatar.node("hips")},
                         {"colliderGroups", {1, 5}},
                         {"joints",
                          {{{"node", hair[0]},
                            {"hitRadius", 0.03},
                            {"stiffness", 2.5},
                            {"gravityPower", 0.5},
                            {"gravityDir", {0, 0, 4}},
                            {"dragForce", 0.7}},
                           {{"node", hair[1]}},
                           {{"node", hair[2]}}}}}};
  const AvatarModel model = model_of(avatar);
  ASSERT_EQ(model.colliders.size(), 2u);
  EXPECT_EQ(model.colliders[0].centre_m, model.colliders[0].tail_m);
  EXPECT_EQ(model.colliders[1].tail_m, Eigen::Vector3f(0, 0.3f, 0));
  ASSERT_EQ(model.springs.size(), 1u);
  const AvatarSpring& spring = model.springs[0];
  EXPECT_EQ(spring.colliders, (std::vector<std::uint32_t>{1}));
  EXPECT_EQ(spring.centre, model.node_of(Bone::kHips));
  ASSERT_EQ(spring.joints.size(), 2u);  // the third marks the end of the second
  EXPECT_EQ(name_of_node(model, spring.joints[0].node), "hair0");
  EXPECT_FLOAT_EQ(spring.joints[0].radius_m, 0.03f);
  EXPECT_FLOAT_EQ(spring.joints[0].stiffness, 2.5f);
  EXPECT_FLOAT_EQ(spring.joints[0].gravity, 0.5f);
  EXPECT_FLOAT_EQ(spring.joints[0].drag, 0.7f);
  EXPECT_EQ(spring.joints[0].gravity_direction, Eigen::Vector3f(0, 0, 1));
  EXPECT_LT((spring.joints[1].tail_m - Eigen::Vector3f(0, -0.1f, 0)).norm(), 1e-6f);
}

TEST(AvatarLife, SpringsOfVrm0AreAllThatIsBelowTheirRoots) {
  TinyAvatar avatar({}, true);  // as VRM 0.x faces
  const auto hair = add_hair(avatar);
  avatar.add_node("curl", hair[0], {0.1f, 1.55f, -0.1f});
  avatar.add_mesh(avatar.square());
  auto& animation = avatar.json["extensions"]["VRM"]["secondaryAnimation"];
  animation["colliderGroups"] = {
      {{"node", avatar.node("head")},
       {"colliders", {{{"offset", {{"x", 0.1}, {"y", 0.2}, {"z", 0.3}}}, {"radius", 0.1}}}}}};
  animation["boneGroups"] = {{{"stiffiness", 1.5},
                              {"gravityPower", 0.2},
                              {"gravityDir", {{"x", 1}, {"y", 0}, {"z", 0}}},
                              {"dragForce", 0.6},
                              {"hitRadius", 0.05},
                              {"center", -1},
                              {"bones", {hair[0], hair[0]}},
                              {"colliderGroups", {0}}}};
  const AvatarModel model = model_of(avatar);
  ASSERT_EQ(model.springs.size(), 2u);  // the hair, and the curl beside it
  ASSERT_EQ(model.springs[0].joints.size(), 3u);
  EXPECT_EQ(name_of_node(model, model.springs[0].joints[2].node), "hair2");
  EXPECT_LT((model.springs[0].joints[2].tail_m - Eigen::Vector3f(0, -0.07f, 0)).norm(), 1e-6f);
  EXPECT_EQ(name_of_node(model, model.springs[1].joints[0].node), "curl");
  EXPECT_FLOAT_EQ(model.springs[1].joints[0].stiffness, 1.5f);
  // What pulled to the right of the file's figure pulls to the left of the turned one.
  EXPECT_LT((model.springs[0].joints[0].gravity_direction - Eigen::Vector3f(-1, 0, 0)).norm(),
            1e-6f);
  ASSERT_EQ(model.colliders.size(), 1u);
  EXPECT_EQ(model.colliders[0].centre_m, Eigen::Vector3f(0.1f, 0.2f, -0.3f));
}

TEST(AvatarLife, MoreThanMaySwingIsNoted) {
  TinyAvatar avatar;
  int above = avatar.node("head");
  json strands = json::array();
  for (int s = 0; s < 6; ++s) {
    json joints = json::array();
    int node = above;
    for (int n = 0; n < 51; ++n) {
      node = avatar.add_node("hair", node, {0, 1.6f - 0.01f * static_cast<float>(n), -0.1f});
      joints.push_back({{"node", node}});
    }
    strands.push_back({{"joints", joints}, {"colliderGroups", {0}}});
  }
  avatar.add_mesh(avatar.square());
  auto& springs = avatar.json["extensions"]["VRMC_springBone"];
  springs["springs"] = strands;
  std::vector<std::string> notes;
  EXPECT_EQ(model_of(avatar, &notes).springs.size(), 6u);
  EXPECT_EQ(notes,
            std::vector<std::string>{"300 nodes swing, more than 256; the rest stays at rest"});
  const json ball = {{"node", above}, {"shape", {{"sphere", {{"radius", 0.1}}}}}};
  springs["colliders"] = json(std::size_t{20}, ball);
  json all = json::array();
  for (int c = 0; c < 20; ++c) all.push_back(c);
  springs["colliderGroups"] = {{{"colliders", all}}};
  model_of(avatar, &notes);
  ASSERT_EQ(notes.size(), 2u);
  EXPECT_NE(notes[1].find("more than 4096 pairs"), std::string::npos) << notes[1];
}

TEST(AvatarLife, BonesOfTheBodyDoNotSwing) {
  TinyAvatar avatar;
  avatar.add_mesh(avatar.square());
  avatar.json["extensions"]["VRMC_springBone"]["springs"] = {
      {{"joints", {{{"node", avatar.node("hips")}}, {{"node", avatar.node("spine")}}}}}};
  std::vector<std::string> notes;
  EXPECT_TRUE(model_of(avatar, &notes).springs.empty());
  EXPECT_EQ(notes.size(), 1u);
}

TEST(AvatarLife, FirstPersonFlagsOfBothVrms) {
  TinyAvatar avatar;
  const int node = avatar.add_mesh(avatar.square());
  auto& annotations = avatar.json["extensions"]["VRMC_vrm"]["firstPerson"]["meshAnnotations"];
  annotations = {{{"node", node}, {"type", "thirdPersonOnly"}}};
  EXPECT_EQ(model_of(avatar).parts.at(0).first_person, FirstPerson::kThirdPersonOnly);
  annotations[0]["type"] = "firstPersonOnly";
  EXPECT_EQ(model_of(avatar).parts.at(0).first_person, FirstPerson::kFirstPersonOnly);
  avatar.json.erase("extensions");
  EXPECT_EQ(model_of(avatar).parts.at(0).first_person, FirstPerson::kAuto);
  avatar.json["extensions"]["VRM"]["firstPerson"]["meshAnnotations"] = {
      {{"mesh", 0}, {"firstPersonFlag", "Both"}}};
  EXPECT_EQ(model_of(avatar).parts.at(0).first_person, FirstPerson::kBoth);
}

TEST(AvatarLife, NameAndLicenceArePrintable) {
  TinyAvatar avatar;
  avatar.add_mesh(avatar.square());
  EXPECT_EQ(model_of(avatar).name, "file.glb");
  avatar.json["asset"]["copyright"] = "2024 Somebody \x1b]0;title";
  EXPECT_EQ(model_of(avatar).licence, "2024 Somebody ?]0;title");
  avatar.json["extensions"]["VRMC_vrm"]["meta"] = {{"name", "Ann\nB"},
                                                   {"authors", {"A\x1b[31m", "B"}},
                                                   {"licenseUrl", "https://vrm.dev/licenses/1.0/"},
                                                   {"avatarPermission", "everyone"},
                                                   {"allowRedistribution", true}};
  const AvatarModel model = model_of(avatar);
  EXPECT_EQ(model.name, "Ann?B");
  EXPECT_EQ(model.licence,
            "by A?[31m; by B; licence https://vrm.dev/licenses/1.0/; worn by everyone; "
            "redistribution: allowed");
  avatar.json["extensions"] = {
      {"VRM",
       {{"meta",
         {{"title", std::string(5000, 'x')}, {"author", "Jin"}, {"licenseName", "CC_BY"}}}}}};
  EXPECT_LT(model_of(avatar).name.size(), 100u);
  EXPECT_EQ(model_of(avatar).licence, "by Jin; licence CC_BY");
}

}  // namespace
}  // namespace dance
