#include "producers/receive/joint_figure.h"

#include <gtest/gtest.h>

#include "core/pose/kinematics.h"
#include "tests/allocation_guard.h"
#include "tests/core/pose/random_pose.h"
#include "tests/formats/rokoko/rokoko_couple.h"

namespace dance {
namespace {

constexpr float kTenthOfAMillimetre = 1e-4f;

FigureFrame figure_of_dancer(const Skeleton& skeleton, const Pose& pose) {
  BodyFrames frames;
  forward_kinematics(skeleton, pose, frames);
  FigureFrame figure;
  for (std::size_t b = 0; b < kBoneCount; ++b)
    figure.put(static_cast<Bone>(b), frames.p_WB_m[b], frames.R_WB[b]);
  return figure;
}

void remove(FigureFrame& figure, Bone bone) { figure.presence &= ~(1u << index_of(bone)); }

float worst_m(const JointFigure& fitted, const Pose& pose, const FigureFrame& wanted) {
  BodyFrames frames;
  forward_kinematics(fitted.skeleton(), pose, frames);
  float worst = 0.0f;
  for (std::size_t b = 0; b < kBoneCount; ++b)
    if (wanted.has(static_cast<Bone>(b)))
      worst = std::max(worst, (frames.p_WB_m[b] - wanted.p_WB_m[b]).norm());
  return worst;
}

TEST(JointFigure, AWholeFigureIsThatDancerAtOnce) {
  Random random(3);
  const Skeleton skeleton = average_skeleton(1.55f);
  JointFigure figure;
  for (int i = 0; i < 200; ++i) {
    const Pose pose = random_pose(random, 1.0f);
    Pose fitted;
    const FigureFrame wanted = figure_of_dancer(skeleton, pose);
    ASSERT_TRUE(figure.fit(wanted, fitted));
    EXPECT_LT(worst_m(figure, fitted, wanted), kTenthOfAMillimetre);
    EXPECT_EQ(fitted.presence, kAllBones);
    for (std::size_t b = 0; b < kBoneCount; ++b)
      EXPECT_TRUE(is_same_rotation(fitted.R_PB[b], pose.R_PB[b]));
  }
}

// Of the trunk only two joints, whose rotations are anything.
TEST(JointFigure, WithoutAChestTheJointsThatCameStayWhereTheyAre) {
  SalsaDancer dancer = salsa_dancer(SalsaRole::kFollow);
  JointFigure figure;
  for (int i = 0; i < 600; ++i) {
    Pose pose;
    dancer.dance_at(Duration::ms(16 * i), pose);
    FigureFrame wanted = figure_of_dancer(dancer.skeleton(), pose);
    remove(wanted, Bone::kChest);
    Pose fitted;
    ASSERT_TRUE(figure.fit(wanted, fitted));
    EXPECT_LT(worst_m(figure, fitted, wanted), kTenthOfAMillimetre) << i;
    EXPECT_TRUE(is_valid(fitted));
    EXPECT_TRUE(is_valid(figure.skeleton()));
  }
}

// A millimetre of noise on each joint, as of mocap with markers.
TEST(JointFigure, ASkeletonIsNotToldAgainForNoise) {
  for (const bool has_chest : {true, false}) {
    Random random(11);
    SalsaDancer dancer = salsa_dancer(SalsaRole::kFollow);
    JointFigure figure;
    Skeleton told;
    int tellings = 0;
    for (int i = 0; i < 3000; ++i) {
      Pose pose, fitted;
      dancer.dance_at(Duration::ms(10 * i), pose);
      FigureFrame frame = figure_of_dancer(dancer.skeleton(), pose);
      for (Eigen::Vector3f& p_m : frame.p_WB_m)
        for (int axis = 0; axis < 3; ++axis)
          p_m[axis] += static_cast<float>(random.uniform(-0.001, 0.001));
      if (!has_chest) remove(frame, Bone::kChest);
      ASSERT_TRUE(figure.fit(frame, fitted));
      if (i > 0 && !(figure.skeleton() == told)) ++tellings;
      told = figure.skeleton();
      if (has_chest) {
        EXPECT_LT(worst_m(figure, fitted, frame), 0.012f);
      }
    }
    RecordProperty(has_chest ? "tellings" : "tellings_without_chest", tellings);
    EXPECT_LT(tellings, has_chest ? 5 : 60);
  }
}

TEST(JointFigure, FiguresWithoutHeadArmsOrLegsAreRefused) {
  JointFigure figure;
  Pose pose;
  for (const Bone bone : {Bone::kHips, Bone::kHead, Bone::kLeftLowerArm, Bone::kRightUpperLeg}) {
    FigureFrame frame = figure_of_dancer(average_skeleton(), Pose());
    remove(frame, bone);
    EXPECT_FALSE(figure.fit(frame, pose));
  }
  EXPECT_FALSE(figure.fit(FigureFrame(), pose));
}

TEST(JointFigure, OtherMissingJointsFollowTheirParents) {
  JointFigure figure;
  Pose pose;
  FigureFrame frame = figure_of_dancer(average_skeleton(), Pose());
  for (const Bone bone :
       {Bone::kSpine, Bone::kChest, Bone::kUpperChest, Bone::kNeck, Bone::kLeftShoulder,
        Bone::kRightShoulder, Bone::kLeftHand, Bone::kRightToes, Bone::kRightFoot})
    remove(frame, bone);
  ASSERT_TRUE(figure.fit(frame, pose));
  EXPECT_TRUE(is_valid(pose));
  EXPECT_LT(worst_m(figure, pose, frame), kTenthOfAMillimetre);
  EXPECT_EQ(pose.presence, frame.presence);
}

TEST(JointFigure, AnotherBodyIsLearntAnew) {
  JointFigure figure;
  Pose pose;
  for (const float height_m : {1.9f, 1.2f}) {
    const FigureFrame wanted = figure_of_dancer(average_skeleton(height_m), Pose());
    ASSERT_TRUE(figure.fit(wanted, pose));
    EXPECT_LT(worst_m(figure, pose, wanted), kTenthOfAMillimetre);
  }
}

TEST(JointFigure, TheHipsStandAsHighAsTheLegsAreLong) {
  JointFigure figure;
  Pose pose;
  ASSERT_TRUE(figure.fit(figure_of_dancer(average_skeleton(1.6f), Pose()), pose));
  EXPECT_NEAR(figure.skeleton().hips_height_m(), average_skeleton(1.6f).hips_height_m(), 0.02f);
  figure.set_heights(1.65f, 0.93f);
  ASSERT_TRUE(figure.fit(figure_of_dancer(average_skeleton(1.6f), Pose()), pose));
  EXPECT_NEAR(figure.skeleton().hips_height_m(), 0.93f, 1e-3f);
}

TEST(JointFigure, IsFittedWithoutAllocating) {
  JointFigure figure;
  Pose pose;
  const FigureFrame frame = figure_of_dancer(average_skeleton(), Pose());
  const AllocationGuard guard;
  for (int i = 0; i < 5; ++i) EXPECT_TRUE(figure.fit(frame, pose));
  EXPECT_EQ(guard.allocations(), 0u);
}

}  // namespace
}  // namespace dance
