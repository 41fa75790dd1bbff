// Tests where figures of other exporters stand, and that our own files are read as written.
#include <gtest/gtest.h>

#include "formats/bvh/retarget.h"
#include "formats/gltf/glb.h"
#include "tests/formats/bvh/built_figure.h"

namespace dance {
namespace {

using Eigen::Vector3d;
using test::built_human;
using test::BuiltFigure;

constexpr float kSamePlace_m = 1e-3f;

// The hips below a root of their own, which stands on the floor.
BuiltFigure human_below_armature() {
  BuiltFigure figure;
  figure.add("Armature", "", {0, 0, 0});
  const BuiltFigure human = built_human({});
  for (const test::BuiltJoint& joint : human.joints())
    figure.add(
        joint.name,
        joint.parent < 0 ? "Armature" : human.joints()[static_cast<std::size_t>(joint.parent)].name,
        joint.offset_cm, joint.end_cm);
  return figure;
}

Result<Retargeted> read_at_its_height(const std::string& text) {
  const auto bvh = read_bvh(text);
  if (!bvh) return tl::make_unexpected(bvh.error());
  RetargetOptions options;
  options.puts_feet_on_floor = false;
  return retarget(*bvh, options);
}

TEST(Retarget, ReadsPositionsOfHipsBelowARootByTheFloor) {
  // The position channels hold the place itself, wherever the OFFSET is.
  BuiltFigure figure = human_below_armature();
  figure.at("Hips").offset_cm = Vector3d(0, 74, -122);
  figure.set_position("Hips", {0, 95, 0});
  const auto placed = read_at_its_height(figure.bvh());
  ASSERT_TRUE(placed.has_value()) << placed.error().what;
  EXPECT_LT((placed->clip.frames[0].p_WH_m - Eigen::Vector3f(0, 0.95f, 0)).norm(), kSamePlace_m);
  // The position channels are added to the OFFSET.
  figure.at("Hips").offset_cm = Vector3d(0, 95, 0);
  figure.set_position("Hips", {0, 3, 10});
  const auto added = read_at_its_height(figure.bvh());
  ASSERT_TRUE(added.has_value()) << added.error().what;
  EXPECT_LT((added->clip.frames[0].p_WH_m - Eigen::Vector3f(0, 0.98f, 0.1f)).norm(), kSamePlace_m);
}

TEST(PlacedRigs, ReplacesTheRestOfTheHipsByTheirTranslation) {
  BuiltFigure figure = human_below_armature();
  figure.at("Hips").offset_cm = Vector3d(0, 74, -122);
  const std::string bytes = figure.glb("Hips", {0, 0.95, 0});
  const auto clips = read_glb({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()});
  ASSERT_TRUE(clips.has_value()) << clips.error().what;
  for (const Pose& pose : clips->front().clip.frames)
    EXPECT_LT((pose.p_WH_m - Eigen::Vector3f(0, 0.95f, 0)).norm(), kSamePlace_m);
}

void expect_identical(const MotionClip& a, const MotionClip& b) {
  ASSERT_EQ(a.frames.size(), b.frames.size());
  ASSERT_EQ(a.hands.size(), b.hands.size());
  for (std::size_t bone = 0; bone < kBoneCount; ++bone)
    EXPECT_LT((a.skeleton.offset_m[bone] - b.skeleton.offset_m[bone]).norm(), 1e-5f)
        << kBones[bone].name;
  for (std::size_t tip = 0; tip < kTipCount; ++tip)
    EXPECT_LT((a.skeleton.tip_m[tip] - b.skeleton.tip_m[tip]).norm(), 1e-5f) << "tip " << tip;
  constexpr float kSame_rad = 2e-3f;  // the resolution of a unit quaternion of floats
  for (std::size_t f = 0; f < a.frames.size(); ++f) {
    EXPECT_LT((a.frames[f].p_WH_m - b.frames[f].p_WH_m).norm(), 1e-5f);
    for (std::size_t bone = 0; bone < kBoneCount; ++bone)
      EXPECT_LT(a.frames[f].R_PB[bone].angularDistance(b.frames[f].R_PB[bone]), kSame_rad)
          << kBones[bone].name;
    if (a.hands.empty()) continue;
    for (std::size_t bone = 0; bone < kFingerBoneCount; ++bone)
      EXPECT_LT(a.hands[f].R_PB[bone].angularDistance(b.hands[f].R_PB[bone]), kSame_rad)
          << kFingerBones[bone].name;
  }
}

TEST(Retarget, ChangesNothingOfFilesOfOurOwn) {
  test::RigWords words;
  words.fingers = test::mixamo_fingers();
  BuiltFigure figure = built_human(words);
  figure.turn("LeftForeArm", {0, 0, -40});
  figure.turn("RightUpLeg", {0, -50, 0});
  figure.turn("LeftHand", {20, 10, 5});
  figure.turn("RightHandMiddle2", {40, 0, 0});
  const auto first = read_at_its_height(figure.bvh());
  ASSERT_TRUE(first.has_value()) << first.error().what;
  std::vector<MotionClip> written{first->clip};
  // A GLB of fewer than eight frames is sampled 60 times a second.
  for (std::size_t f = 2; f < 10; ++f) {
    written[0].frames.push_back(first->clip.frames[f % 2]);
    written[0].hands.push_back(first->clip.hands[f % 2]);
  }
  written.push_back(written[0]);
  written.back().hands.clear();
  // A body that nobody measured, off the floor.
  written.push_back(written[1]);
  written.back().skeleton = average_skeleton(0.9f);
  for (Pose& pose : written.back().frames) pose.p_WH_m.y() += 0.7f;
  for (const MotionClip& clip : written) {
    const auto again = read_at_its_height(write_bvh(clip));
    ASSERT_TRUE(again.has_value()) << again.error().what;
    expect_identical(clip, again->clip);
  }
  const std::vector<NamedClip> couple{{"alice", written[0], {}}, {"bob", written[2], {}}};
  const auto bytes = write_glb(couple);
  ASSERT_TRUE(bytes.has_value()) << bytes.error().what;
  const auto read = read_glb(*bytes);
  ASSERT_TRUE(read.has_value()) << read.error().what;
  ASSERT_EQ(read->size(), 2u);
  for (std::size_t i = 0; i < 2; ++i) expect_identical(couple[i].clip, (*read)[i].clip);
}

}  // namespace
}  // namespace dance
