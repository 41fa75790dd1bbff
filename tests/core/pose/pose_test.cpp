#include "core/pose/pose.h"

#include <gtest/gtest.h>

#include <limits>
#include <type_traits>

#include "tests/core/pose/random_pose.h"

namespace dance {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

TEST(Bones, ComeAfterTheirParents) {
  EXPECT_EQ(kBones[0].parent, -1);
  for (std::size_t i = 1; i < kBoneCount; ++i) {
    EXPECT_GE(kBones[i].parent, 0);
    EXPECT_LT(kBones[i].parent, static_cast<int>(i)) << kBones[i].name;
  }
  for (std::size_t i = 0; i < kFingerBoneCount; ++i)
    EXPECT_LT(kFingerBones[i].parent, static_cast<int>(i)) << kFingerBones[i].name;
}

TEST(Bones, AreFoundByTheirNamesOnly) {
  for (std::size_t i = 0; i < kBoneCount; ++i)
    EXPECT_EQ(find_bone(kBones[i].name), static_cast<Bone>(i));
  EXPECT_EQ(find_bone("leftFoot"), Bone::kLeftFoot);
  EXPECT_FALSE(find_bone("LeftFoot"));
  EXPECT_FALSE(find_bone(""));
}

TEST(Pose, IsAValidTPoseWhenNew) {
  const Pose pose;
  EXPECT_TRUE(is_valid(pose));
  for (const auto& rotation : pose.R_PB)
    EXPECT_TRUE(is_same_rotation(rotation, Eigen::Quaternionf::Identity(), 0.0f));
  EXPECT_TRUE(is_valid(Hands()));
}

TEST(Pose, IsInvalidWhenAnyRotationIsNotUnit) {
  const float wrong[] = {kNan, kInfinity, -kInfinity, 1e30f, -1e30f, 0.2f, 1e-30f};
  for (std::size_t bone = 0; bone < kBoneCount; ++bone) {
    for (int i = 0; i < 4; ++i) {
      for (const float value : wrong) {
        Pose pose;
        pose.R_PB[bone].coeffs()[i] = value;
        const bool is_unit = i != 3 && std::abs(value) < 1e-3f;  // 1e-30 beside w = 1
        EXPECT_EQ(is_valid(pose), is_unit) << bone << " " << i << " " << value;
      }
    }
    Pose zero;
    zero.R_PB[bone].coeffs().setZero();
    EXPECT_FALSE(is_valid(zero));
  }
}

TEST(Pose, ForgivesOnePercentOfLengthAndNoMore) {
  Random random(11);
  for (int i = 0; i < 200; ++i) {
    Pose pose = random_pose(random);
    auto& coefficients = pose.R_PB[random.below(kBoneCount)].coeffs();
    const Eigen::Vector4f unit = coefficients;
    coefficients = unit * 1.008f;
    EXPECT_TRUE(is_valid(pose));
    coefficients = unit * 0.992f;
    EXPECT_TRUE(is_valid(pose));
    coefficients = unit * 1.012f;
    EXPECT_FALSE(is_valid(pose));
    coefficients = unit * 0.988f;
    EXPECT_FALSE(is_valid(pose));
  }
}

TEST(Pose, IsInvalidOffTheStage) {
  for (int axis = 0; axis < 3; ++axis) {
    for (const float value : {kNan, kInfinity, -kInfinity, 1001.0f, -1001.0f, 1e30f}) {
      Pose pose;
      pose.p_WH_m[axis] = value;
      EXPECT_FALSE(is_valid(pose)) << axis << " " << value;
    }
    Pose pose;
    pose.p_WH_m[axis] = -kMaxStageDistance_m;
    EXPECT_TRUE(is_valid(pose));
  }
}

TEST(Pose, IsInvalidWithConfidenceOrMusicOutOfRange) {
  Pose pose;
  for (const float value : {kNan, -0.01f, 1.01f, kInfinity}) {
    pose.confidence = value;
    EXPECT_FALSE(is_valid(pose)) << value;
  }
  pose.confidence = 0.0f;
  EXPECT_TRUE(is_valid(pose));
  pose.music_beats = 12.25;
  EXPECT_TRUE(is_valid(pose));
  pose.music_beats = std::numeric_limits<double>::infinity();
  EXPECT_FALSE(is_valid(pose));
  pose.music_beats = -std::numeric_limits<double>::infinity();
  EXPECT_FALSE(is_valid(pose));
  pose.music_beats = kNoMusic;
  EXPECT_TRUE(is_valid(pose));
}

TEST(Pose, IsExactlyUnitAndUnturnedOnceNormalised) {
  Random random(12);
  for (int i = 0; i < 100; ++i) {
    const Pose original = random_pose(random);
    Pose pose = original;
    for (auto& rotation : pose.R_PB)
      rotation.coeffs() *= static_cast<float>(random.uniform(0.991, 1.009));
    normalize(pose);
    for (std::size_t b = 0; b < kBoneCount; ++b) {
      EXPECT_NEAR(pose.R_PB[b].norm(), 1.0f, 1e-6f);
      EXPECT_TRUE(is_same_rotation(pose.R_PB[b], original.R_PB[b]));
    }
  }
}

TEST(Pose, KeepsOneStampPerHop) {
  Pose pose;
  for (std::size_t i = 0; i < kHopCount; ++i) {
    EXPECT_FALSE(pose.stamped(static_cast<Hop>(i)).is_set());
    pose.stamp(static_cast<Hop>(i), MonoTime::from_us(static_cast<std::int64_t>(i) + 1));
  }
  for (std::size_t i = 0; i < kHopCount; ++i)
    EXPECT_EQ(pose.hops[i], MonoTime::from_us(static_cast<std::int64_t>(i) + 1));
}

TEST(Hands, AreInvalidWhenAnyFingerIsNotUnit) {
  for (std::size_t bone = 0; bone < kFingerBoneCount; ++bone) {
    Hands hands;
    hands.R_PB[bone].y() = kNan;
    EXPECT_FALSE(is_valid(hands));
    hands.R_PB[bone].coeffs() = Eigen::Vector4f(0, 0, 0, 1.005f);
    EXPECT_TRUE(is_valid(hands));
    normalize(hands);
    EXPECT_FLOAT_EQ(hands.R_PB[bone].w(), 1.0f);
  }
}

}  // namespace
}  // namespace dance
