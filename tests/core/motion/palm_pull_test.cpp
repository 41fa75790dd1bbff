#include "core/motion/palm_pull.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/motion/rotation_vector.h"
#include "tests/allocation_guard.h"

namespace dance {
namespace {

using Eigen::Vector3f;

// Arms half raised before the body, elbows bent.
Pose arms_before() {
  Pose pose;
  pose.R_PB[index_of(Bone::kLeftUpperArm)] = exp_rotation(Vector3f(0.0f, -0.9f, -0.6f));
  pose.R_PB[index_of(Bone::kRightUpperArm)] = exp_rotation(Vector3f(0.0f, 0.9f, 0.6f));
  pose.R_PB[index_of(Bone::kLeftLowerArm)] = exp_rotation(Vector3f(0.0f, -1.0f, 0.0f));
  pose.R_PB[index_of(Bone::kRightLowerArm)] = exp_rotation(Vector3f(0.0f, 1.0f, 0.0f));
  return pose;
}

std::array<Vector3f, 2> palms_of(const Skeleton& skeleton, const Pose& pose) {
  BodyFrames frames;
  forward_kinematics(skeleton, pose, frames);
  return {palm_of(skeleton, frames, 0), palm_of(skeleton, frames, 1)};
}

TEST(PalmPull, BringsBothPalmsToWhereTheyAreKnownToBe) {
  const Skeleton skeleton = average_skeleton();
  const Pose before = arms_before();
  const auto was = palms_of(skeleton, before);
  const Vector3f left(0.06f, 0.05f, -0.07f), right(-0.02f, 0.1f, 0.04f);
  Pose pose = before;
  EXPECT_TRUE(pull_palms(skeleton, {{{left, 1.0f}, {right, 1.0f}}}, pose));
  const auto is = palms_of(skeleton, pose);
  EXPECT_LT((is[0] - was[0] - left).norm(), 0.004f);
  EXPECT_LT((is[1] - was[1] - right).norm(), 0.004f);
  for (const auto& q : pose.R_PB) EXPECT_NEAR(q.norm(), 1.0f, 1e-5f);
  // What the palms do not hang on is where it was.
  for (const Bone bone : {Bone::kLeftUpperLeg, Bone::kRightLowerLeg, Bone::kHead, Bone::kNeck})
    EXPECT_LT(pose.R_PB[index_of(bone)].angularDistance(before.R_PB[index_of(bone)]), 1e-6f);
  EXPECT_EQ(pose.p_WH_m.y(), before.p_WH_m.y());
}

TEST(PalmPull, TakesTheShareThatIsRight) {
  const Skeleton skeleton = average_skeleton();
  const Vector3f shift(0.03f, 0.04f, -0.05f);
  float last = 0.0f;
  for (const float share : {0.1f, 0.3f, 0.5f, 0.8f, 1.0f}) {
    Pose pose = arms_before();
    const auto was = palms_of(skeleton, pose);
    pull_palms(skeleton, {{{shift, share}, {}}}, pose);
    const Vector3f moved = palms_of(skeleton, pose)[0] - was[0];
    const float part = moved.dot(shift) / shift.squaredNorm();
    // More along the ways that a body gives easily.
    EXPECT_NEAR(part, share, 0.25f) << share;
    EXPECT_GT(part, last);
    last = part;
  }
}

TEST(PalmPull, LeavesAFreeArmToItself) {
  const Skeleton skeleton = average_skeleton();
  const Pose before = arms_before();
  Pose pose = before;
  EXPECT_FALSE(pull_palms(skeleton, {}, pose));
  EXPECT_FALSE(pull_palms(skeleton, {{{Vector3f(0.1f, 0.0f, 0.0f), 0.0f}, {}}}, pose));
  for (std::size_t b = 0; b < kBoneCount; ++b)
    EXPECT_TRUE(pose.R_PB[b].coeffs() == before.R_PB[b].coeffs());
  EXPECT_TRUE(pull_palms(skeleton, {{{Vector3f(0.1f, 0.0f, 0.0f), 1.0f}, {}}}, pose));
  for (const Bone bone : {Bone::kRightShoulder, Bone::kRightUpperArm, Bone::kRightHand})
    EXPECT_TRUE(pose.R_PB[index_of(bone)].coeffs() == before.R_PB[index_of(bone)].coeffs());
}

TEST(PalmPull, AnElbowTurnsAboutItsHingeOnly) {
  const Skeleton skeleton = average_skeleton();
  Pose pose = arms_before();
  pull_palms(skeleton, {{{Vector3f(0.1f, 0.08f, 0.05f), 1.0f}, {}}}, pose);
  const Vector3f elbow = rotation_vector(pose.R_PB[index_of(Bone::kLeftLowerArm)]);
  EXPECT_LT(std::hypot(elbow.x(), elbow.z()), 0.02f);
}

TEST(PalmPull, WhatIsNoNumberIsNoPullAndFarPlacesBreakNothing) {
  const Skeleton skeleton = average_skeleton();
  const float nan = std::numeric_limits<float>::quiet_NaN();
  Pose pose = arms_before();
  EXPECT_FALSE(pull_palms(skeleton, {{{Vector3f(nan, 0, 0), 1.0f}, {}}}, pose));
  EXPECT_FALSE(pull_palms(skeleton, {{{Vector3f(0.1f, 0, 0), nan}, {}}}, pose));
  for (const float far : {0.6f, 5.0f, 1e6f}) {
    pose = arms_before();
    const auto was = palms_of(skeleton, pose);
    EXPECT_TRUE(pull_palms(skeleton, {{{Vector3f(far, 0, far), 1.0f}, {}}}, pose));
    EXPECT_TRUE(is_valid(pose));
    EXPECT_LT((palms_of(skeleton, pose)[0] - was[0]).norm(), 0.8f);
  }
}

TEST(PalmPull, AllocatesNothing) {
  const Skeleton skeleton = average_skeleton();
  Pose pose = arms_before();
  const AllocationGuard guard;
  pull_palms(skeleton, {{{Vector3f(0.1f, 0, 0), 0.5f}, {Vector3f(0, 0.1f, 0), 0.7f}}}, pose);
  EXPECT_EQ(guard.allocations(), 0u);
}

}  // namespace
}  // namespace dance
