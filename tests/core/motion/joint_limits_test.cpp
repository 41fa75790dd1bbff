#include "core/motion/joint_limits.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/pose/kinematics.h"
#include "tests/core/pose/random_pose.h"
#include "tests/transformers/real_takes.h"

namespace dance {
namespace {

constexpr float kDegree_rad = 0.017453293f;

Eigen::Quaternionf turn_deg(float degrees, const Eigen::Vector3f& axis) {
  return Eigen::Quaternionf(Eigen::AngleAxisf(degrees * kDegree_rad, axis));
}

float knee_rad(const Pose& pose, Bone knee) {
  const Eigen::Quaternionf& q = pose.R_PB[index_of(knee)];
  return 2.0f * std::atan2(q.x(), q.w());
}

TEST(JointLimits, APoseWithinThemIsNotTouched) {
  Pose pose;
  pose.R_PB[index_of(Bone::kLeftLowerArm)] = turn_deg(-140, Eigen::Vector3f::UnitY());
  pose.R_PB[index_of(Bone::kRightLowerLeg)] = turn_deg(120, Eigen::Vector3f::UnitX());
  pose.R_PB[index_of(Bone::kLeftUpperLeg)] = turn_deg(-100, Eigen::Vector3f::UnitX());
  const Pose before = pose;
  EXPECT_EQ(limit_joints(pose), 0);
  for (std::size_t b = 0; b < kBoneCount; ++b)
    EXPECT_EQ(pose.R_PB[b].coeffs(), before.R_PB[b].coeffs()) << b;
}

TEST(JointLimits, KneesAndElbowsDoNotBendBackwards) {
  for (const float angle_deg : {20.0f, 60.0f, 120.0f}) {
    Pose pose;
    pose.R_PB[index_of(Bone::kLeftLowerLeg)] = turn_deg(-angle_deg, Eigen::Vector3f::UnitX());
    pose.R_PB[index_of(Bone::kRightLowerLeg)] = turn_deg(-angle_deg, Eigen::Vector3f::UnitX());
    pose.R_PB[index_of(Bone::kLeftLowerArm)] = turn_deg(angle_deg, Eigen::Vector3f::UnitY());
    pose.R_PB[index_of(Bone::kRightLowerArm)] = turn_deg(-angle_deg, Eigen::Vector3f::UnitY());
    EXPECT_EQ(limit_joints(pose), 4);
    BodyFrames frames;
    const Skeleton skeleton = average_skeleton();
    forward_kinematics(skeleton, pose, frames);
    EXPECT_GT(knee_rad(pose, Bone::kLeftLowerLeg), -15.1f * kDegree_rad);
    EXPECT_GT(knee_rad(pose, Bone::kRightLowerLeg), -15.1f * kDegree_rad);
    for (const Limb& arm : {kLeftArm, kRightArm})
      EXPECT_GT(frames.position(arm.end).z() - frames.position(arm.lower).z(),
                -0.25f * std::sin(18.1f * kDegree_rad));
  }
}

TEST(JointLimits, TheSidesAreMirrorImages) {
  Random random(1);
  for (int i = 0; i < 200; ++i) {
    Pose pose = random_pose(random);
    Pose mirrored = pose;
    const auto mirror = [](const Eigen::Quaternionf& q) {
      return Eigen::Quaternionf(q.w(), q.x(), -q.y(), -q.z());
    };
    for (std::size_t b = index_of(Bone::kLeftShoulder); b < kBoneCount; ++b) {
      const bool is_left = (b - index_of(Bone::kLeftShoulder)) % 8 < 4;
      mirrored.R_PB[b] = mirror(pose.R_PB[is_left ? b + 4 : b - 4]);
    }
    limit_joints(pose);
    limit_joints(mirrored);
    for (std::size_t b = index_of(Bone::kLeftShoulder); b < kBoneCount; ++b) {
      const bool is_left = (b - index_of(Bone::kLeftShoulder)) % 8 < 4;
      EXPECT_TRUE(is_same_rotation(mirrored.R_PB[b], mirror(pose.R_PB[is_left ? b + 4 : b - 4])));
    }
  }
}

TEST(JointLimits, GiveWayWithoutAKink) {
  // Steps of 0.1° in: steps out change by little from one to the next, and never turn round.
  float before_rad = 0.0f, step_before_rad = 0.0f;
  for (int i = 0; i < 600; ++i) {
    Pose pose;
    pose.R_PB[index_of(Bone::kLeftLowerLeg)] =
        turn_deg(-0.1f * static_cast<float>(i), Eigen::Vector3f::UnitX());
    limit_joints(pose);
    const float angle_rad = -knee_rad(pose, Bone::kLeftLowerLeg);
    const float step_rad = angle_rad - before_rad;
    if (i > 1) {
      EXPECT_GE(step_rad, -1e-5f);
      EXPECT_NEAR(step_rad, step_before_rad, 0.03f * 0.1f * kDegree_rad + 2e-6f) << i;
    }
    before_rad = angle_rad;
    step_before_rad = step_rad;
  }
}

TEST(JointLimits, AJointBentTooFarIsNotOneBentTheOtherWay) {
  constexpr std::size_t kElbow = index_of(Bone::kLeftLowerArm);
  Eigen::Quaternionf before;
  for (int deg = 100; deg <= 230; ++deg) {
    Pose pose;
    pose.R_PB[kElbow] = Eigen::Quaternionf(
        Eigen::AngleAxisf(-0.017453293f * static_cast<float>(deg), Eigen::Vector3f::UnitY()));
    limit_joints(pose);
    if (deg > 100) {
      EXPECT_LT(pose.R_PB[kElbow].angularDistance(before), 0.02f) << deg;
    }
    before = pose.R_PB[kElbow];
  }
}

TEST(JointLimits, WhateverComesInIsABodyAfterwards) {
  Random random(2);
  for (int i = 0; i < 2000; ++i) {
    Pose pose = random_pose(random);
    limit_joints(pose);
    ASSERT_TRUE(is_valid(pose));
    Pose again = pose;
    limit_joints(again);
    for (std::size_t b = 0; b < kBoneCount; ++b)
      ASSERT_LT(again.R_PB[b].angularDistance(pose.R_PB[b]), 30.0f * kDegree_rad) << b;
  }
}

// 60_01's feet are broken for 188 frames, and the begin of 60_10 trembles: those two are the ones
// left out.
TEST(JointLimits, LeaveRealDancesAsTheyAre) {
  const std::vector<RealTake> takes =
      real_takes({"cmu_60_05_salsa", "cmu_61_07_salsa", "cmu_61_12_salsa", "cmu_131_01_mj_style"});
  if (takes.empty()) GTEST_SKIP() << "no real takes beside this tree";
  for (const RealTake& take : takes) {
    int touched = 0;
    for (Pose pose : take.poses) touched += limit_joints(pose);
    EXPECT_EQ(touched, 0) << take.name;
  }
}

}  // namespace
}  // namespace dance
