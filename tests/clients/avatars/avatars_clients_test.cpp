// The avatars that come with the project as independent programs understand them: three-vrm in
// Chromium, Blender, and Khronos's validator.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>

#include "formats/avatar/make/avatar_maker.h"
#include "formats/avatar/mannequin_model.h"
#include "formats/avatar/vrm_writer.h"
#include "formats/body/figure_builder.h"
#include "tests/apps/run_program.h"

namespace dance {
namespace {

using nlohmann::json;

constexpr const char* kModules = DANCE_SOURCE_DIR "/build/clients/node_modules";
constexpr const char* kScripts = DANCE_SOURCE_DIR "/tests/clients/avatars/";
constexpr const char* kNoModules =
    "npm packages are missing; fetch them with: tests/clients/fetch_clients.sh";
constexpr const char* kNoChromium =
    "Chromium is missing; install it with: apt-get install chromium";
constexpr const char* kNoBlender =
    "Blender is missing; install it with: apt-get install blender python3-numpy";

bool has_module(const std::string& name) {
  return run("node --version").exit_code == 0 &&
         std::filesystem::exists(std::string(kModules) + "/" + name);
}

std::string shipped(std::string_view name) {
  return DANCE_SOURCE_DIR "/data/avatars/" + std::string(name) + ".vrm";
}

// What three-vrm says of the avatars of a scene.
json seen_by_three_vrm(const TestFolder& folder, const json& scene) {
  std::ofstream(folder.path("scene.json")) << scene.dump();
  const Finished finished = run(std::string("node ") + kScripts + "three_vrm.mjs " + kModules +
                                " " + folder.path("scene.json"));
  const json seen = json::parse(finished.output, nullptr, false);
  EXPECT_TRUE(seen.is_object() && seen.contains("avatars")) << finished.output << finished.talk;
  return seen;
}

class AvatarClients : public ::testing::TestWithParam<std::string_view> {};

TEST_P(AvatarClients, TheValidatorOfKhronosFindsNoError) {
  if (!has_module("gltf-validator")) GTEST_SKIP() << kNoModules;
  const Finished finished = run("node " DANCE_SOURCE_DIR "/tests/clients/files/gltf_issues.cjs " +
                                std::string(kModules) + " " + shipped(GetParam()));
  const json report = json::parse(finished.output, nullptr, false);
  ASSERT_TRUE(report.is_object()) << finished.output << finished.talk;
  EXPECT_EQ(report["errors"], 0) << finished.output;
  EXPECT_EQ(report["warnings"], 0) << finished.output;
}

TEST_P(AvatarClients, ThreeVrmFindsBonesLicenceExpressionsAndSprings) {
  if (!has_module("@pixiv/three-vrm") || !has_module("three")) GTEST_SKIP() << kNoModules;
  if (run("chromium --version").exit_code != 0) GTEST_SKIP() << kNoChromium;
  const TestFolder folder("three-vrm");
  const json seen = seen_by_three_vrm(folder, {{"avatars", {{{"file", shipped(GetParam())}}}}});
  const json& avatar = seen["avatars"][0];
  EXPECT_EQ(avatar["meta"]["metaVersion"], "1");
  EXPECT_EQ(avatar["meta"]["name"], std::string(GetParam()));
  EXPECT_EQ(avatar["meta"]["otherLicenseUrl"], kAvatarLicenceUrl);
  EXPECT_EQ(avatar["meta"]["allowRedistribution"], true);
  EXPECT_EQ(avatar["bones"], 22 + 30 + 2);
  EXPECT_EQ(avatar["materials"], (json{"ShaderMaterial"}));  // three-vrm's MToon
  EXPECT_TRUE(avatar["finite"].get<bool>());
  const AvatarModel model = make_avatar(*find_design(GetParam()));
  EXPECT_EQ(avatar["triangles"].get<std::size_t>(), model.triangles.size() / 3);
  std::size_t joints = 0;
  for (const AvatarSpring& spring : model.springs) joints += spring.joints.size();
  EXPECT_EQ(avatar["spring_joints"].get<std::size_t>(), joints);
  const auto expressions = avatar["expressions"].get<std::set<std::string>>();
  for (const AvatarExpression& expression : model.expressions)
    EXPECT_TRUE(expressions.contains(expression.name)) << expression.name;
  EXPECT_NEAR(avatar["box"]["min"][1].get<double>(), 0.0, 0.01);
  EXPECT_NEAR(avatar["box"]["max"][1].get<double>(),
              static_cast<double>(find_design(GetParam())->height_m), 0.06);
}

// A pose of the file's own axes goes the right way: a raised knee is in front, a raised hand above.
TEST_P(AvatarClients, ThreeVrmBendsItAndItStaysInOnePiece) {
  if (!has_module("@pixiv/three-vrm") || !has_module("three")) GTEST_SKIP() << kNoModules;
  if (run("chromium --version").exit_code != 0) GTEST_SKIP() << kNoChromium;
  const TestFolder folder("three-vrm-bent");
  const json pose{{"leftUpperLeg", {-90, 0, 0}},
                  {"leftLowerLeg", {90, 0, 0}},
                  {"leftUpperArm", {0, 0, 80}},
                  {"rightUpperArm", {0, 0, -80}}};
  const json seen =
      seen_by_three_vrm(folder, {{"avatars", {{{"file", shipped(GetParam())}, {"pose", pose}}}},
                                 {"picture", folder.path("bent.png")}});
  const json& box = seen["avatars"][0]["box"];
  const double height_m = static_cast<double>(find_design(GetParam())->height_m);
  EXPECT_GT(box["max"][1].get<double>(), 1.15 * height_m);
  EXPECT_LT(box["max"][1].get<double>(), 1.4 * height_m);
  EXPECT_GT(box["max"][2].get<double>(), 0.25 * height_m);
  EXPECT_LT(box["max"][2].get<double>(), 0.5 * height_m);
  EXPECT_GT(box["min"][2].get<double>(), -0.35 * height_m);
  EXPECT_GT(std::filesystem::file_size(folder.path("bent.png")), 5000u);
}

TEST_P(AvatarClients, BlenderOpensItWithEveryBoneInItsPlace) {
  if (run("blender -b --factory-startup --python-exit-code 3 --python-expr 'import numpy'")
          .exit_code != 0)
    GTEST_SKIP() << kNoBlender;
  const TestFolder folder("blender-avatar");
  const Finished finished =
      run("HOME=" + folder.path() + " blender -b --factory-startup -P " + kScripts +
          "blender_avatar.py -- " + shipped(GetParam()) + " " + folder.path("seen.json"));
  const json seen = json::parse(text_of(folder.path("seen.json")), nullptr, false);
  ASSERT_TRUE(seen.is_object()) << finished.output << finished.talk;
  const TposePlaces places(average_skeleton(find_design(GetParam())->height_m));
  for (std::size_t b = 0; b < kBoneCount; ++b) {
    const std::string bone(kBones[b].name);
    ASSERT_TRUE(seen["joints"].contains(bone)) << bone;
    for (int axis = 0; axis < 3; ++axis)
      EXPECT_NEAR(seen["joints"][bone][static_cast<std::size_t>(axis)].get<double>(),
                  static_cast<double>(places.bones_m[b][axis]), 1e-4)
          << bone;
  }
  EXPECT_NEAR(seen["low_m"].get<double>(), 0.0, 0.01);
  EXPECT_GT(seen["moved"].get<int>(), 100);
  EXPECT_LT(seen["stretched_m"].get<double>(), 0.06);
  // Beside pictures of Blender's own.
  for (const json& size : {json{256, 256}, json{128, 128}})
    EXPECT_NE(std::ranges::find(seen["images"], size), seen["images"].end()) << size;
  const auto keys = seen["shape_keys"].get<std::set<std::string>>();
  for (const char* morph : {"aa", "blinkLeft", "blinkRight", "happy", "surprised"})
    EXPECT_TRUE(keys.contains(morph)) << morph;
}

INSTANTIATE_TEST_SUITE_P(Shipped, AvatarClients, ::testing::Values("marisol", "teo"),
                         [](const auto& avatar) { return std::string(avatar.param); });

// A figure without springs: the mannequin.
TEST(MannequinClients, ThreeVrmOpensAMannequinThatIsWritten) {
  if (!has_module("@pixiv/three-vrm") || !has_module("three")) GTEST_SKIP() << kNoModules;
  if (run("chromium --version").exit_code != 0) GTEST_SKIP() << kNoChromium;
  const TestFolder folder("three-vrm-mannequin");
  const AvatarModel model =
      mannequin_model(average_skeleton(), look_of(*GuestId::parse("bob")), true);
  VrmMeta meta;
  meta.authors = {"test"};
  const auto file = write_vrm(model, meta);
  ASSERT_TRUE(file) << file.error().what;
  std::ofstream(folder.path("bob.vrm"), std::ios::binary)
      .write(reinterpret_cast<const char*>(file->data()),
             static_cast<std::streamsize>(file->size()));
  const json seen = seen_by_three_vrm(folder, {{"avatars", {{{"file", folder.path("bob.vrm")}}}}});
  EXPECT_EQ(seen["avatars"][0]["bones"], 22 + 30 + 2) << "body, fingers and eyes";
  EXPECT_EQ(seen["avatars"][0]["triangles"].get<std::size_t>(), model.triangles.size() / 3);
}

}  // namespace
}  // namespace dance
