#include <gtest/gtest.h>

#include "core/base/random.h"
#include "core/pose/kinematics.h"
#include "formats/bvh/retarget.h"
#include "tests/core/pose/random_pose.h"
#include "tests/formats/bvh/bvh_sample.h"

namespace dance {
namespace {

constexpr float kTenthOfAMillimetre_m = 1e-4f;

// Nothing guessed, so that the writer is tested and not the guesses.
RetargetOptions as_written() {
  RetargetOptions options;
  options.puts_feet_on_floor = false;
  options.up = UpAxis::kY;
  options.metres_per_unit = 1.0;
  return options;
}

MotionClip random_clip(std::uint64_t seed) {
  Random random(seed);
  MotionClip clip;
  clip.skeleton = average_skeleton(1.6f + 0.3f * static_cast<float>(random.uniform()));
  clip.frame_hz = 120.0;
  clip.frames.resize(20);  // the first is a T-pose
  for (std::size_t f = 1; f < clip.frames.size(); ++f) {
    for (auto& rotation : clip.frames[f].R_PB) rotation = random_rotation(random, 1.0f);
    clip.frames[f].p_WH_m += Eigen::Vector3f(static_cast<float>(random.uniform(-3.0, 3.0)),
                                             static_cast<float>(random.uniform(-0.2, 0.2)),
                                             static_cast<float>(random.uniform(-3.0, 3.0)));
  }
  return clip;
}

void expect_same_places(const MotionClip& a, const MotionClip& b) {
  ASSERT_EQ(a.frames.size(), b.frames.size());
  BodyFrames in_a;
  BodyFrames in_b;
  for (std::size_t f = 0; f < a.frames.size(); ++f) {
    forward_kinematics(a.skeleton, a.frames[f], in_a);
    forward_kinematics(b.skeleton, b.frames[f], in_b);
    for (std::size_t bone = 0; bone < kBoneCount; ++bone)
      EXPECT_LT((in_a.p_WB_m[bone] - in_b.p_WB_m[bone]).norm(), kTenthOfAMillimetre_m)
          << kBones[bone].name << " in frame " << f;
    for (std::size_t tip = 0; tip < kTipCount; ++tip)
      EXPECT_LT((in_a.p_WT_m[tip] - in_b.p_WT_m[tip]).norm(), kTenthOfAMillimetre_m);
  }
}

TEST(BvhWriter, IsReadAgainToATenthOfAMillimetre) {
  const RetargetOptions options = as_written();
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const MotionClip clip = random_clip(seed);
    const auto bvh = read_bvh(write_bvh(clip));
    ASSERT_TRUE(bvh.has_value()) << bvh.error().what;
    const auto again = retarget(*bvh, options);
    ASSERT_TRUE(again.has_value()) << again.error().what;
    EXPECT_DOUBLE_EQ(again->clip.frame_hz, clip.frame_hz);
    expect_same_places(clip, again->clip);
  }
}

TEST(BvhWriter, WritesFingersThatAreReadAgain) {
  Random random(11);
  MotionClip clip = random_clip(3);
  clip.hands.resize(clip.frames.size());
  for (std::size_t f = 1; f < clip.frames.size(); ++f)
    for (auto& rotation : clip.hands[f].R_PB) rotation = random_rotation(random, 0.6f);
  const auto bvh = read_bvh(write_bvh(clip));
  ASSERT_TRUE(bvh.has_value()) << bvh.error().what;
  EXPECT_EQ(bvh->joints.size(), kBoneCount + kFingerBoneCount);
  const auto again = retarget(*bvh, as_written());
  ASSERT_TRUE(again.has_value()) << again.error().what;
  expect_same_places(clip, again->clip);
  ASSERT_EQ(again->clip.hands.size(), clip.hands.size());
  for (std::size_t f = 0; f < clip.hands.size(); ++f)
    for (std::size_t bone = 0; bone < kFingerBoneCount; ++bone)
      ASSERT_TRUE(
          is_same_rotation(clip.hands[f].R_PB[bone], again->clip.hands[f].R_PB[bone], 2e-3f))
          << kFingerBones[bone].name << " in frame " << f;
}

TEST(BvhWriter, IsReadAgainWithTheSameRotations) {
  const RetargetOptions options = as_written();
  const MotionClip clip = random_clip(7);
  const auto again = retarget(*read_bvh(write_bvh(clip)), options);
  ASSERT_TRUE(again.has_value()) << again.error().what;
  // Bones that lie along the T-pose's axes need no correction, so they keep their rotations too.
  for (const Bone bone :
       {Bone::kHips, Bone::kChest, Bone::kHead, Bone::kLeftUpperArm, Bone::kLeftLowerArm})
    EXPECT_LT(clip.frames[5].R_PB[index_of(bone)].angularDistance(
                  again->clip.frames[5].R_PB[index_of(bone)]),
              1e-3f)
        << kBones[index_of(bone)].name;
}

TEST(BvhWriter, KeepsACapturedFigure) {
  RetargetOptions options;
  options.puts_feet_on_floor = false;
  const auto first = retarget(*read_bvh(test::sample("mixamo")), options);
  ASSERT_TRUE(first.has_value()) << first.error().what;
  const auto second = retarget(*read_bvh(write_bvh(first->clip)), options);
  ASSERT_TRUE(second.has_value()) << second.error().what;
  expect_same_places(first->clip, second->clip);
}

TEST(BvhWriter, StaysARotationAtThePole) {
  MotionClip clip;
  clip.skeleton = average_skeleton();
  clip.frames.resize(2);
  const Eigen::Quaternionf pole(Eigen::AngleAxisf(1.57079632679f, Eigen::Vector3f::UnitX()));
  const Eigen::Quaternionf turned(Eigen::AngleAxisf(0.7f, Eigen::Vector3f::UnitY()));
  clip.frames[1].R_PB[index_of(Bone::kLeftLowerLeg)] = pole * turned;
  const RetargetOptions options = as_written();
  const auto again = retarget(*read_bvh(write_bvh(clip)), options);
  ASSERT_TRUE(again.has_value()) << again.error().what;
  expect_same_places(clip, again->clip);
}

}  // namespace
}  // namespace dance
