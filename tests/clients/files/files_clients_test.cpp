// GLB and BVH files as Blender, three.js and Khronos's validator understand them: each joint where
// our own kinematics have it, and skinned bodies that go with them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "formats/bvh/clip_file.h"
#include "formats/gltf/glb.h"
#include "formats/recording/clips_together.h"
#include "formats/recording/log_source.h"
#include "tests/apps/run_program.h"
#include "tests/clients/files/known_joints.h"
#include "tests/test_folder.h"

namespace dance {
namespace {

using nlohmann::json;

constexpr double kTenthOfAMillimetre_m = 1e-4;
constexpr const char* kShippedCouple = DANCE_SOURCE_DIR "/logs/couple-packed.lcm";
constexpr const char* kScripts = DANCE_SOURCE_DIR "/tests/clients/files/";
constexpr const char* kModules = DANCE_SOURCE_DIR "/build/clients/node_modules";
// Real captures, from Debian's assimp-testmodels.
constexpr const char* kTakes[] = {"/usr/share/assimp/models/BVH/01_01.bvh",
                                  "/usr/share/assimp/models/BVH/Boxing_Toes.bvh"};

std::vector<NamedClip> shipped_couple() {
  auto source = LogSource::open(kShippedCouple);
  EXPECT_TRUE(source.has_value()) << source.error().what;
  Recording recording;
  EXPECT_TRUE(source->read_into(recording).has_value());
  std::vector<NamedClip> clips;
  for (auto& of : clips_together(recording, 60.0).clips)
    clips.push_back({std::string(of.guest.view()), std::move(of.clip), {}});
  return clips;
}

std::string number(double value) { return std::to_string(value); }

// Some frames, evenly over the whole dance.
struct Sampling {
  std::size_t count = 12;
  std::size_t step = 1;
  explicit Sampling(std::size_t frames)
      : count(std::min<std::size_t>(12, frames)),
        step(std::max<std::size_t>(1, (frames - 1) / 11)) {}
  std::string arguments(double rate_hz) const {
    return " 0 " + std::to_string(count) + " " + std::to_string(step) + " " + number(rate_hz);
  }
};

void write_file(const std::string& path, const void* bytes, std::size_t size) {
  std::ofstream file(path, std::ios::binary);
  file.write(static_cast<const char*>(bytes), static_cast<std::streamsize>(size));
}

std::string write_glb_file(const TestFolder& folder, const std::vector<NamedClip>& clips) {
  const auto bytes = write_glb(clips);
  EXPECT_TRUE(bytes.has_value()) << bytes.error().what;
  write_file(folder.path("dance.glb"), bytes->data(), bytes->size());
  return folder.path("dance.glb");
}

json seen_by(const std::string& command, const std::string& out) {
  const Finished finished = run(command);
  const json seen = json::parse(text_of(out), nullptr, false);
  EXPECT_TRUE(seen.is_object()) << command << "\n" << finished.output << finished.talk;
  return seen;
}

json seen_by_blender(const TestFolder& folder, const std::string& file, const Sampling& sampling,
                     double rate_hz) {
  return seen_by("HOME=" + folder.path() + " blender -b --factory-startup -P " + kScripts +
                     "blender_joints.py -- " + file + " " + folder.path("blender.json") +
                     sampling.arguments(rate_hz),
                 folder.path("blender.json"));
}

void expect_near(const json& seen, const Eigen::Vector3f& known, const std::string& what) {
  ASSERT_TRUE(seen.is_array() && seen.size() == 3) << what << " is missing";
  for (int axis = 0; axis < 3; ++axis)
    ASSERT_NEAR(seen[static_cast<std::size_t>(axis)].get<double>(),
                static_cast<double>(known[axis]), kTenthOfAMillimetre_m)
        << what;
}

// Every joint of every dancer in every frame that was sampled.
void expect_dance(const json& seen, const std::vector<NamedClip>& clips) {
  ASSERT_TRUE(seen.contains("frames") && !seen["frames"].empty());
  for (const json& frame : seen["frames"])
    for (const NamedClip& named : clips) {
      const auto f = frame["frame"].get<std::size_t>();
      ASSERT_TRUE(frame["joints"].contains(named.name));
      const json& joints = frame["joints"][named.name];
      for (const auto& [name, place] : test::known_joints(named.clip, f))
        expect_near(joints.value(name, json()), place,
                    named.name + "'s " + name + " in frame " + std::to_string(f));
    }
}

// A body whose vertices are all near its bones, and whose feet are on the floor.
void expect_bodies(const json& seen, std::size_t dancers) {
  for (const json& frame : seen["frames"]) {
    ASSERT_EQ(frame["bodies"].size(), dancers);
    for (const auto& [name, body] : frame["bodies"].items()) {
      EXPECT_TRUE(body["finite"].get<bool>()) << name;
      EXPECT_GT(body["vertices"].get<int>(), 5000) << name;
      EXPECT_LT(body["furthest_from_bones_m"].get<double>(), 0.35) << name;
      EXPECT_GT(body["lowest_m"].get<double>(), -0.05) << name;
      EXPECT_LT(body["lowest_m"].get<double>(), 0.3) << name;
    }
  }
}

// In a BVH the ends are no joints: Blender makes them the tails of their bones.
void name_tails_ends(json& seen) {
  for (json& frame : seen["frames"])
    for (json& joints : frame["joints"]) {
      const json as_seen = joints;
      for (const auto& [name, place] : as_seen.items())
        if (const auto tail = name.find("/tail"); tail != name.npos)
          joints[name.substr(0, tail) + "End"] = place;
    }
}

bool has_blender() {
  return run("blender -b --factory-startup --python-exit-code 3 --python-expr 'import numpy'")
             .exit_code == 0;
}
bool has_module(const std::string& name) {
  return run("node --version").exit_code == 0 &&
         std::filesystem::exists(std::string(kModules) + "/" + name);
}

constexpr const char* kNoBlender =
    "Blender is missing; install it with: apt-get install blender python3-numpy";
constexpr const char* kNoModules =
    "npm packages are missing; fetch them with: tests/clients/fetch_clients.sh";

TEST(FilesClients, BlenderOpensTheShippedCouplesGlbWithEveryJointInItsPlace) {
  if (!has_blender()) GTEST_SKIP() << kNoBlender;
  const TestFolder folder("blender-glb");
  const auto clips = shipped_couple();
  ASSERT_EQ(clips.size(), 2u);
  ASSERT_FALSE(clips[0].clip.hands.empty());
  const json seen = seen_by_blender(folder, write_glb_file(folder, clips),
                                    Sampling(clips[0].clip.frames.size()), 60.0);
  expect_dance(seen, clips);
  expect_bodies(seen, 2);
}

TEST(FilesClients, BlenderOpensTheShippedCouplesBvhWithEveryJointInItsPlace) {
  if (!has_blender()) GTEST_SKIP() << kNoBlender;
  const TestFolder folder("blender-bvh");
  for (NamedClip& named : shipped_couple()) {
    const std::string file = folder.path(named.name + ".bvh");
    const std::string text = write_bvh(named.clip);
    write_file(file, text.data(), text.size());
    json seen = seen_by_blender(folder, file, Sampling(named.clip.frames.size()), 60.0);
    name_tails_ends(seen);
    expect_dance(seen, {named});
  }
}

TEST(FilesClients, BlenderOpensRealCapturesWrittenAsGlbAndAsBvh) {
  if (!has_blender()) GTEST_SKIP() << kNoBlender;
  for (const char* take : kTakes) {
    if (!std::filesystem::exists(take))
      GTEST_SKIP() << "captures are missing; install them with: apt-get install assimp-testmodels";
    const TestFolder folder("blender-take");
    auto loaded = load_clip(take);
    ASSERT_TRUE(loaded.has_value()) << loaded.error().what;
    loaded->clip.frames.resize(std::min<std::size_t>(loaded->clip.frames.size(), 600));
    if (!loaded->clip.hands.empty()) loaded->clip.hands.resize(loaded->clip.frames.size());
    const std::vector<NamedClip> clips{{"dancer", std::move(loaded->clip), {}}};
    const double rate_hz = clips[0].clip.frame_hz;
    const Sampling sampling(clips[0].clip.frames.size());
    expect_dance(seen_by_blender(folder, write_glb_file(folder, clips), sampling, rate_hz), clips);
    const std::string text = write_bvh(clips[0].clip);
    write_file(folder.path("dancer.bvh"), text.data(), text.size());
    json seen = seen_by_blender(folder, folder.path("dancer.bvh"), sampling, rate_hz);
    name_tails_ends(seen);
    expect_dance(seen, clips);
  }
}

TEST(FilesClients, AGlbThatBlenderExportsIsReadWithEveryBoneInItsPlace) {
  if (!has_blender()) GTEST_SKIP() << kNoBlender;
  const TestFolder folder("blender-export");
  NamedClip alice = shipped_couple().front();
  alice.clip.frames.resize(90);
  alice.clip.hands.resize(90);
  const std::string text = write_bvh(alice.clip);
  write_file(folder.path("alice.bvh"), text.data(), text.size());
  const Finished finished = run("HOME=" + folder.path() + " blender -b --factory-startup -P " +
                                kScripts + "blender_export.py -- " + folder.path("alice.bvh") +
                                " " + folder.path("alice.glb") + " 90 60");
  const auto bytes = bytes_in(folder.path("alice.glb"));
  const auto again = read_glb(bytes);
  ASSERT_TRUE(again.has_value()) << again.error().what << finished.output << finished.talk;
  ASSERT_EQ(again->size(), 1u);
  const MotionClip& clip = again->front().clip;
  EXPECT_DOUBLE_EQ(clip.frame_hz, 60.0);
  ASSERT_EQ(clip.frames.size(), alice.clip.frames.size());
  EXPECT_EQ(clip.hands.size(), alice.clip.hands.size());
  BodyFrames known;
  BodyFrames read;
  for (std::size_t f = 0; f < clip.frames.size(); ++f) {
    forward_kinematics(alice.clip.skeleton, alice.clip.frames[f], known);
    forward_kinematics(clip.skeleton, clip.frames[f], read);
    for (std::size_t b = 0; b < kBoneCount; ++b)
      ASSERT_LT((known.p_WB_m[b] - read.p_WB_m[b]).norm(), 1e-4f)
          << kBones[b].name << " in frame " << f;
  }
}

TEST(FilesClients, ThreeJsPlaysTheShippedCouplesGlbWithEveryJointInItsPlace) {
  if (!has_module("three")) GTEST_SKIP() << kNoModules;
  const TestFolder folder("three");
  const auto clips = shipped_couple();
  const std::string file = write_glb_file(folder, clips);
  const json seen =
      seen_by(std::string("node ") + kScripts + "three_joints.mjs " + kModules + " " + file + " " +
                  folder.path("three.json") + Sampling(clips[0].clip.frames.size()).arguments(60.0),
              folder.path("three.json"));
  expect_dance(seen, clips);
  expect_bodies(seen, 2);
  EXPECT_NEAR(seen["duration_s"].get<double>(),
              static_cast<double>(clips[0].clip.frames.size() - 1) / 60.0, 1e-3);
}

TEST(FilesClients, TheValidatorOfKhronosFindsNothing) {
  if (!has_module("gltf-validator")) GTEST_SKIP() << kNoModules;
  const TestFolder folder("gltf-validator");
  std::vector<NamedClip> clips = shipped_couple();
  for (const std::size_t dancers : {std::size_t{2}, std::size_t{1}}) {
    clips.resize(dancers);
    const Finished finished = run(std::string("node ") + kScripts + "gltf_issues.cjs " + kModules +
                                  " " + write_glb_file(folder, clips));
    const json report = json::parse(finished.output, nullptr, false);
    ASSERT_TRUE(report.is_object()) << finished.output << finished.talk;
    EXPECT_EQ(report["errors"], 0) << finished.output;
    EXPECT_EQ(report["warnings"], 0) << finished.output;
  }
}

TEST(FilesClients, AvatarAppsFindTheBonesOfASingleDancersVrmAnimation) {
  if (!has_module("@pixiv/three-vrm-animation") || !has_module("three")) GTEST_SKIP() << kNoModules;
  const TestFolder folder("vrm-animation");
  std::vector<NamedClip> clips = shipped_couple();
  clips.resize(1);
  const Finished finished = run(std::string("node ") + kScripts + "vrm_animation.mjs " + kModules +
                                " " + write_glb_file(folder, clips));
  const json seen = json::parse(finished.output, nullptr, false);
  ASSERT_TRUE(seen.is_object()) << finished.output << finished.talk;
  EXPECT_EQ(seen["animations"], 1);
  expect_near(seen["rest_hips"], clips[0].clip.skeleton.offset_m[0], "the hips at rest");
  expect_near(seen["hips"], clips[0].clip.frames[0].p_WH_m, "the hips in the first frame");
  const auto rotated = seen["rotated"].get<std::vector<std::string>>();
  for (const char* bone : {"hips", "spine", "leftUpperArm", "rightLowerLeg", "leftIndexProximal"})
    EXPECT_NE(std::find(rotated.begin(), rotated.end(), bone), rotated.end()) << bone;
}

}  // namespace
}  // namespace dance
