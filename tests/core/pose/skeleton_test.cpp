#include "core/pose/skeleton.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "core/pose/kinematics.h"

namespace dance {
namespace {

BodyFrames standing(const Skeleton& skeleton) {
  Pose pose;
  pose.p_WH_m = skeleton.offset_m[0];
  BodyFrames frames;
  forward_kinematics(skeleton, pose, frames);
  return frames;
}

TEST(AverageSkeleton, StandsWithItsFeetOnTheFloor) {
  for (const float height_m : {1.2f, 1.72f, 2.05f}) {
    const BodyFrames frames = standing(average_skeleton(height_m));
    EXPECT_NEAR(frames.tip(Tip::kLeftToes).y(), 0.0f, 1e-4f);
    EXPECT_NEAR(frames.tip(Tip::kRightToes).y(), 0.0f, 1e-4f);
    for (const auto& p : frames.p_WB_m) EXPECT_GT(p.y(), 0.0f);
  }
}

TEST(AverageSkeleton, IsAsTallAsItIsAskedToBe) {
  for (const float height_m : {1.2f, 1.72f, 2.05f}) {
    const Skeleton skeleton = average_skeleton(height_m);
    EXPECT_NEAR(standing_height_m(skeleton), height_m, 1e-4f);
    EXPECT_NEAR(standing(skeleton).tip(Tip::kHead).y(), height_m, 1e-4f);
  }
}

TEST(AverageSkeleton, HasMirroredSides) {
  const BodyFrames frames = standing(average_skeleton());
  const auto mirrored = [](const Eigen::Vector3f& p) {
    return Eigen::Vector3f(-p.x(), p.y(), p.z());
  };
  for (std::size_t i = 0; i < kBoneCount; ++i) {
    const std::string_view name = kBones[i].name;
    if (!name.starts_with("left")) continue;
    const auto right = find_bone("right" + std::string(name.substr(4)));
    ASSERT_TRUE(right.has_value()) << name;
    EXPECT_TRUE(frames.position(*right).isApprox(mirrored(frames.p_WB_m[i]), 1e-5f)) << name;
    EXPECT_GT(frames.p_WB_m[i].x(), 0.0f) << name;  // +X is the dancer's left
  }
}

TEST(AverageSkeleton, FacesForwardWithItsToes) {
  const BodyFrames frames = standing(average_skeleton());
  EXPECT_GT(frames.tip(Tip::kLeftToes).z(), frames.position(Bone::kLeftFoot).z());
}

TEST(Skeleton, IsInvalidWithBonesThatAreNotABody) {
  EXPECT_TRUE(is_valid(average_skeleton()));
  using Limits = std::numeric_limits<float>;
  for (const float wrong :
       {Limits::quiet_NaN(), Limits::infinity(), -Limits::infinity(), 2.01f, -1e30f}) {
    for (std::size_t i = 0; i < kBoneCount; ++i) {
      for (int axis = 0; axis < 3; ++axis) {
        Skeleton skeleton = average_skeleton();
        skeleton.offset_m[i][axis] = wrong;
        EXPECT_FALSE(is_valid(skeleton)) << i << " " << axis << " " << wrong;
      }
    }
    for (std::size_t i = 0; i < kTipCount; ++i) {
      Skeleton skeleton = average_skeleton();
      skeleton.tip_m[i].z() = wrong;
      EXPECT_FALSE(is_valid(skeleton)) << i << " " << wrong;
    }
  }
}

TEST(Skeleton, DiffersWhenOneBoneDoes) {
  const Skeleton a = average_skeleton();
  Skeleton b = a;
  EXPECT_TRUE(a == b);
  b.offset_m[7].x() += 0.001f;
  EXPECT_FALSE(a == b);
}

}  // namespace
}  // namespace dance
