#include "core/pose/kinematics.h"

#include <gtest/gtest.h>

#include "tests/allocation_guard.h"
#include "tests/core/pose/random_pose.h"

namespace dance {
namespace {

using Eigen::AngleAxisf;
using Eigen::Quaternionf;
using Eigen::Vector3f;

constexpr float kHalfPi_rad = 1.5707963f;

TEST(ForwardKinematics, AddsUpOffsetsInTPose) {
  const Skeleton skeleton = average_skeleton();
  Pose pose;
  pose.p_WH_m = Vector3f(1.0f, 0.935f, -2.0f);
  BodyFrames frames;
  forward_kinematics(skeleton, pose, frames);
  // Left hand: hips, spine, chest, upper chest, shoulder, upper arm, lower arm, hand.
  const Vector3f expected(1.0f + 0.030f + 0.145f + 0.285f + 0.250f,
                          0.935f + 0.100f + 0.115f + 0.125f + 0.090f,
                          -2.0f - 0.010f - 0.005f - 0.010f);
  EXPECT_TRUE(frames.position(Bone::kLeftHand).isApprox(expected, 1e-5f));
  EXPECT_TRUE(frames.tip(Tip::kLeftHand).isApprox(expected + Vector3f(0.185f, 0, 0), 1e-5f));
}

TEST(ForwardKinematics, TurnsWhatHangsOnABone) {
  const Skeleton skeleton = average_skeleton();
  Pose pose;
  pose.p_WH_m.setZero();
  // A quarter turn about +Z takes the arm's +X to +Y: the arm stands up from the shoulder.
  pose.R_PB[index_of(Bone::kLeftUpperArm)] = AngleAxisf(kHalfPi_rad, Vector3f::UnitZ());
  BodyFrames frames;
  forward_kinematics(skeleton, pose, frames);
  const Vector3f p_upper = frames.position(Bone::kLeftUpperArm);
  EXPECT_TRUE(frames.position(Bone::kLeftHand).isApprox(p_upper + Vector3f(0, 0.535f, 0), 1e-4f));
  EXPECT_TRUE(frames.tip(Tip::kLeftHand).isApprox(p_upper + Vector3f(0, 0.720f, 0), 1e-4f));
  // The other side stays.
  EXPECT_NEAR(frames.position(Bone::kRightHand).x(), -0.710f, 1e-5f);
}

TEST(ForwardKinematics, TurnsTheWholeBodyWithTheHips) {
  const Skeleton skeleton = average_skeleton();
  Pose pose;
  BodyFrames rest, turned;
  forward_kinematics(skeleton, pose, rest);
  const Quaternionf R(AngleAxisf(kHalfPi_rad, Vector3f::UnitY()));
  pose.R_PB[0] = R;
  forward_kinematics(skeleton, pose, turned);
  for (std::size_t i = 0; i < kBoneCount; ++i)
    EXPECT_TRUE(turned.p_WB_m[i].isApprox(pose.p_WH_m + R * (rest.p_WB_m[i] - pose.p_WH_m), 1e-5f));
  // +Y by a quarter turn: who faced +Z now faces +X.
  EXPECT_GT(turned.tip(Tip::kLeftToes).x(), turned.position(Bone::kLeftFoot).x() + 0.1f);
}

TEST(ForwardKinematics, KeepsBoneLengthsAndDoesNotCareAboutTheSignOfAQuaternion) {
  Random random(21);
  const Skeleton skeleton = average_skeleton(1.6f);
  for (int i = 0; i < 200; ++i) {
    Pose pose = random_pose(random);
    BodyFrames frames, of_negated;
    forward_kinematics(skeleton, pose, frames);
    for (std::size_t b = 1; b < kBoneCount; ++b) {
      const auto parent = static_cast<std::size_t>(kBones[b].parent);
      EXPECT_NEAR((frames.p_WB_m[b] - frames.p_WB_m[parent]).norm(), skeleton.offset_m[b].norm(),
                  1e-5f);
    }
    for (auto& rotation : pose.R_PB)
      if (random.below(2) == 0) rotation.coeffs() = -rotation.coeffs();
    forward_kinematics(skeleton, pose, of_negated);
    for (std::size_t b = 0; b < kBoneCount; ++b)
      EXPECT_TRUE((of_negated.p_WB_m[b] - frames.p_WB_m[b]).norm() < 1e-5f);
  }
}

class TwoBone : public testing::TestWithParam<Limb> {
 protected:
  // A body that leans and twists at random, so that no parent's frame is the world's.
  void lean(Random& random) {
    pose_ = random_pose(random, 1.2f);
    forward_kinematics(skeleton_, pose_, frames_);
  }
  float length_m(Bone bone) const { return skeleton_.offset(bone).norm(); }
  float longest_m() const { return length_m(limb_.lower) + length_m(limb_.end); }
  float shortest_m() const { return std::abs(length_m(limb_.lower) - length_m(limb_.end)); }
  Vector3f root() const { return frames_.position(limb_.upper); }

  const Limb limb_ = GetParam();
  Skeleton skeleton_ = average_skeleton();
  Pose pose_;
  BodyFrames frames_;
};

TEST_P(TwoBone, ReachesRandomTargetsUnderRandomParents) {
  Random random(31);
  for (int i = 0; i < 2000; ++i) {
    lean(random);
    const auto reach_m =
        static_cast<float>(random.uniform(shortest_m() + 0.01, longest_m() - 0.001));
    const Vector3f target = root() + reach_m * random_direction(random);
    const Vector3f pole = random_direction(random);
    const Quaternionf R_WEnd = random_rotation(random);
    const Pose before = pose_;
    const float missed_m = solve_two_bone(skeleton_, limb_, target, pole, R_WEnd, pose_, frames_);
    EXPECT_EQ(missed_m, 0.0f);
    EXPECT_TRUE(is_valid(pose_));

    BodyFrames solved;
    forward_kinematics(skeleton_, pose_, solved);
    EXPECT_LT((solved.position(limb_.end) - target).norm(), 1e-3f) << i;
    EXPECT_TRUE(is_same_rotation(solved.R_WB[index_of(limb_.end)], R_WEnd)) << i;
    for (const Bone bone : {limb_.upper, limb_.lower, limb_.end}) {
      // What the solver left in its frames is what the pose says.
      EXPECT_LT((solved.position(bone) - frames_.position(bone)).norm(), 1e-3f);
      EXPECT_TRUE(is_same_rotation(solved.R_WB[index_of(bone)], frames_.R_WB[index_of(bone)]));
      EXPECT_NEAR(pose_.R_PB[index_of(bone)].norm(), 1.0f, 1e-5f);
    }
    for (std::size_t b = 0; b < kBoneCount; ++b) {
      const auto bone = static_cast<Bone>(b);
      if (bone == limb_.upper || bone == limb_.lower || bone == limb_.end) continue;
      EXPECT_EQ(pose_.R_PB[b].coeffs(), before.R_PB[b].coeffs()) << kBones[b].name;
    }
  }
}

TEST_P(TwoBone, BendsTowardsThePole) {
  Random random(32);
  for (int i = 0; i < 500; ++i) {
    lean(random);
    const Vector3f along = random_direction(random);
    Vector3f pole = random_direction(random);
    if (std::abs(pole.dot(along)) > 0.95f) continue;
    const Vector3f target = root() + 0.7f * longest_m() * along;
    solve_two_bone(skeleton_, limb_, target, pole, Quaternionf::Identity(), pose_, frames_);
    const Vector3f to_middle = frames_.position(limb_.lower) - root();
    const Vector3f beside = to_middle - along * along.dot(to_middle);
    const Vector3f side = (pole - along * along.dot(pole)).normalized();
    EXPECT_GT(beside.norm(), 0.1f);
    EXPECT_TRUE(beside.normalized().isApprox(side, 1e-2f)) << i;
  }
}

TEST_P(TwoBone, GivesBackTheTPose) {
  forward_kinematics(skeleton_, pose_, frames_);
  const BodyFrames rest = frames_;
  const bool is_arm = limb_.end == Bone::kLeftHand || limb_.end == Bone::kRightHand;
  const float missed_m = solve_two_bone(skeleton_, limb_, rest.position(limb_.end),
                                        Vector3f(0, 0, is_arm ? -1.0f : 1.0f),
                                        Quaternionf::Identity(), pose_, frames_);
  EXPECT_EQ(missed_m, 0.0f);
  // Nearly straight is what it may differ by: the bend of 0.1 mm short of the full length.
  for (const Bone bone : {limb_.upper, limb_.lower, limb_.end})
    EXPECT_TRUE(is_same_rotation(pose_.R_PB[index_of(bone)], Quaternionf::Identity(), 0.08f));
}

TEST_P(TwoBone, TurnsSmoothlyAllTheWayToTheRoot) {
  // Towards the root and back, past the places where one of the bones stands at right angles to the
  // line.
  Random random(33);
  for (int i = 0; i < 50; ++i) {
    lean(random);
    const Vector3f along = random_direction(random);
    Vector3f pole = random_direction(random);
    if (std::abs(pole.dot(along)) > 0.9f) continue;
    Quaternionf upper_before = Quaternionf::Identity(), lower_before = Quaternionf::Identity();
    const float nearest_m = shortest_m() + 0.02f;
    constexpr int kSteps = 400;
    for (int step = 0; step <= kSteps; ++step) {
      const float share = static_cast<float>(step) / kSteps;
      const float reach_m = 0.98f * longest_m() + share * (nearest_m - 0.98f * longest_m());
      solve_two_bone(skeleton_, limb_, root() + reach_m * along, pole, Quaternionf::Identity(),
                     pose_, frames_);
      const Quaternionf upper = frames_.R_WB[index_of(limb_.upper)];
      const Quaternionf lower = frames_.R_WB[index_of(limb_.lower)];
      if (step > 0) {
        EXPECT_LT(upper.angularDistance(upper_before), 0.1f) << reach_m;
        EXPECT_LT(lower.angularDistance(lower_before), 0.1f) << reach_m;
      }
      upper_before = upper;
      lower_before = lower;
    }
  }
}

TEST_P(TwoBone, StretchesTowardsWhatIsOutOfReachAndSaysHowFar) {
  Random random(34);
  for (int i = 0; i < 200; ++i) {
    lean(random);
    const Vector3f along = random_direction(random);
    const auto beyond_m = static_cast<float>(random.uniform(0.01, 3.0));
    const Vector3f target = root() + (longest_m() + beyond_m) * along;
    const float missed_m = solve_two_bone(skeleton_, limb_, target, random_direction(random),
                                          Quaternionf::Identity(), pose_, frames_);
    EXPECT_NEAR(missed_m, beyond_m, 1e-3f);
    EXPECT_NEAR((frames_.position(limb_.end) - target).norm(), missed_m, 1e-3f);
    EXPECT_TRUE(is_valid(pose_));
  }
}

TEST_P(TwoBone, StaysValidOnTargetsWithoutDirection) {
  forward_kinematics(skeleton_, pose_, frames_);
  const Vector3f at_root = root();
  for (const Vector3f& pole : {Vector3f(0, -1, 0), Vector3f(0, 0, 0), Vector3f(1, 0, 0)}) {
    const float missed_m =
        solve_two_bone(skeleton_, limb_, at_root, pole, Quaternionf::Identity(), pose_, frames_);
    EXPECT_NEAR(missed_m, shortest_m(), 1e-3f);
    EXPECT_TRUE(is_valid(pose_));
    EXPECT_TRUE(frames_.position(limb_.end).allFinite());
    // A pole along the line says nothing: any bend will do, but it must be one.
    const Vector3f below = at_root + Vector3f(0, -0.3f, 0);
    EXPECT_EQ(
        solve_two_bone(skeleton_, limb_, below, pole, Quaternionf::Identity(), pose_, frames_),
        0.0f);
    EXPECT_LT((frames_.position(limb_.end) - below).norm(), 1e-3f);
    EXPECT_TRUE(is_valid(pose_));
  }
}

TEST_P(TwoBone, LeavesABodyWithoutThatLimbAsItIs) {
  skeleton_.offset_m[index_of(limb_.lower)].setZero();
  forward_kinematics(skeleton_, pose_, frames_);
  const Vector3f target = frames_.position(limb_.end) + Vector3f(0, 0, 0.5f);
  const float missed_m = solve_two_bone(skeleton_, limb_, target, Vector3f::UnitZ(),
                                        Quaternionf::Identity(), pose_, frames_);
  EXPECT_FLOAT_EQ(missed_m, 0.5f);
  EXPECT_TRUE(is_valid(pose_));
}

TEST_P(TwoBone, AllocatesNothing) {
  forward_kinematics(skeleton_, pose_, frames_);
  const AllocationGuard guard;
  forward_kinematics(skeleton_, pose_, frames_);
  solve_two_bone(skeleton_, limb_, Vector3f(0.2f, 0.5f, 0.3f), Vector3f::UnitZ(),
                 Quaternionf::Identity(), pose_, frames_);
  EXPECT_EQ(guard.allocations(), 0u);
}

INSTANTIATE_TEST_SUITE_P(Limbs, TwoBone, testing::Values(kLeftArm, kRightArm, kLeftLeg, kRightLeg),
                         [](const testing::TestParamInfo<Limb>& limb) {
                           return std::string(kBones[index_of(limb.param.end)].name);
                         });

}  // namespace
}  // namespace dance
