#include "producers/camera/solver/body_model.h"

#include <gtest/gtest.h>

#include "core/base/random.h"
#include "core/pose/kinematics.h"
#include "producers/camera/solver/body_fit.h"
#include "producers/camera/solver/motion_filter.h"

namespace dance {
namespace {

DofVector random_step(Random& random, double size) {
  DofVector step;
  for (int i = 0; i < dof::kCount; ++i) step[i] = size * random.uniform(-1.0, 1.0);
  return step;
}

BodyState random_state(Random& random) {
  BodyState state = state_at_ease();
  move(state, random_step(random, 0.5));
  for (auto& side : state.sides) {
    side.elbow = random.uniform(0.2, 2.0);
    side.knee = random.uniform(0.2, 1.8);
  }
  return state;
}

TEST(BodyState, AStepBetweenTwoPosturesLeadsFromOneToTheOther) {
  Random random(11);
  for (int round = 0; round < 50; ++round) {
    BodyState from = random_state(random);
    const BodyState to = random_state(random);
    move(from, step_between(from, to));
    EXPECT_LT(step_between(from, to).norm(), 1e-9);
  }
}

TEST(BodyState, KneesAndElbowsStopWhereTheyEnd) {
  BodyState state = state_at_ease();
  DofVector step = DofVector::Zero();
  for (int s = 0; s < 2; ++s)
    step[dof::side(s) + dof::kElbow] = step[dof::side(s) + dof::kKnee] = -3.0;
  move(state, step);
  for (const auto& side : state.sides) {
    EXPECT_EQ(side.elbow, 0.0);
    EXPECT_EQ(side.knee, 0.0);
  }
  move(state, -3.0 * step);
  for (const auto& side : state.sides) {
    EXPECT_EQ(side.elbow, kMostElbow_rad);
    EXPECT_EQ(side.knee, kMostKnee_rad);
  }
}

// Two pictures may be stamped microseconds apart; where they differ the body is not as fast as a
// bullet.
TEST(MotionFilter, PicturesOfOneMomentMakeNoSpeed) {
  PartVisibility sight;
  sight.fill(1.0);
  const BodyState here = state_at_ease();
  DofVector centimetre = DofVector::Zero();
  centimetre[dof::kPlace] = 0.01;
  for (const double seconds : {0.0, 1e-6, 1e-4, 1e-3}) {
    MotionFilter memory;
    memory.begin(here);
    BodyState there = here;
    move(there, centimetre);
    memory.follow(memory.expect(seconds, sight), there, seconds);
    const double gone_m = step_between(there, memory.expect(0.01, sight).state)[dof::kPlace] / 0.01;
    EXPECT_GT(gone_m, 0.0) << seconds;
    EXPECT_LT(gone_m, 5.0) << seconds << " s: metres a second";
    // And a speed that it has stays.
    const BodyState now = memory.expect(seconds, sight).state;
    memory.follow(memory.expect(seconds, sight), now, seconds);
    if (seconds > 0.0) {
      EXPECT_NEAR(step_between(now, memory.expect(0.01, sight).state)[dof::kPlace] / 0.01, gone_m,
                  0.01 * gone_m)
          << seconds;
    }
  }
}

TEST(BodyState, TwoMirrorsShowThePoseItself) {
  Random random(12);
  Pose pose;
  write_pose(random_state(random), pose);
  pose.presence = 0x2c0c5u;
  Pose twice = pose;
  mirror(twice);
  EXPECT_NE(twice.presence, pose.presence);
  EXPECT_GT(twice.R_PB[index_of(Bone::kLeftLowerArm)].angularDistance(
                pose.R_PB[index_of(Bone::kLeftLowerArm)]),
            1e-3f);
  mirror(twice);
  EXPECT_EQ(twice.presence, pose.presence);
  EXPECT_EQ(twice.p_WH_m, pose.p_WH_m);
  for (std::size_t b = 0; b < kBoneCount; ++b)
    EXPECT_EQ(twice.R_PB[b].coeffs(), pose.R_PB[b].coeffs());
}

TEST(BodyState, AMirroredPoseHasItsJointsWhereAMirrorHasThem) {
  Random random(13);
  const Skeleton skeleton = average_skeleton();
  for (int round = 0; round < 10; ++round) {
    Pose pose;
    write_pose(random_state(random), pose);
    Pose seen = pose;
    mirror(seen);
    BodyFrames a, b;
    forward_kinematics(skeleton, pose, a);
    forward_kinematics(skeleton, seen, b);
    const auto reflected = [](Eigen::Vector3f p) {
      p.x() = -p.x();
      return p;
    };
    EXPECT_LT((a.position(Bone::kLeftHand) - reflected(b.position(Bone::kRightHand))).norm(),
              1e-5f);
    EXPECT_LT((a.tip(Tip::kRightToes) - reflected(b.tip(Tip::kLeftToes))).norm(), 1e-5f);
    EXPECT_LT((a.tip(Tip::kHead) - reflected(b.tip(Tip::kHead))).norm(), 1e-5f);
  }
}

TEST(BodyModel, BonesAreWhereThePoseHasThem) {
  Random random(14);
  const BodyShape shape = shape_of(average_lengths(1.8));
  BodyModel model;
  for (int round = 0; round < 20; ++round) {
    const BodyState state = random_state(random);
    model.place(shape, state);
    Pose pose;
    write_pose(state, pose);
    BodyFrames frames;
    forward_kinematics(shape.skeleton, pose, frames);
    for (std::size_t b = 0; b < kBoneCount; ++b)
      EXPECT_LT((frames.p_WB_m[b].cast<double>() - model.origin(static_cast<Bone>(b))).norm(), 1e-5)
          << kBones[b].name;
  }
}

TEST(BodyModel, JacobiansAreWhatSmallStepsDo) {
  Random random(15);
  const BodyShape shape = shape_of(average_lengths(1.72));
  BodyModel model, moved;
  for (int round = 0; round < 5; ++round) {
    const BodyState state = random_state(random);
    model.place(shape, state);
    model.differentiate();
    for (int d = 0; d < dof::kCount; ++d) {
      constexpr double kSmall = 1e-5;
      DofVector step = DofVector::Zero();
      step[d] = kSmall;
      BodyState there = state;
      move(there, step);
      moved.place(shape, there);
      // Turns shared out over several bones are followed to the first order of how far they are
      // bent.
      const bool is_shared = d >= dof::kSpine && d < dof::kLeft;
      for (std::size_t i = 0; i < kBodyPointCount; ++i) {
        const Eigen::Vector3d slope = (moved.point(i) - model.point(i)) / kSmall;
        EXPECT_LT((slope - model.jacobian(i).col(d)).norm(), is_shared ? 0.01 : 1e-4)
            << "point " << i << ", way to move " << d;
        if ((model.moved_by(i) >> d & 1u) == 0) {
          EXPECT_EQ(slope.norm(), 0.0);
        }
      }
    }
  }
}

TEST(BodyShape, ABodyHasTheLengthsItWasMadeOf) {
  BodyLengths lengths = average_lengths(1.7);
  lengths[static_cast<std::size_t>(Length::kThigh)] *= 1.1;
  lengths[static_cast<std::size_t>(Length::kShoulders)] *= 0.9;
  const BodyShape shape = shape_of(lengths);
  BodyModel model;
  model.place(shape, BodyState());
  const auto distance = [&](Landmark a, Landmark b) {
    return (model.point(a) - model.point(b)).norm();
  };
  const auto length = [&](Length l) { return lengths[static_cast<std::size_t>(l)]; };
  EXPECT_NEAR(distance(Landmark::kLeftHip, Landmark::kLeftKnee), length(Length::kThigh), 1e-3);
  EXPECT_NEAR(distance(Landmark::kRightKnee, Landmark::kRightAnkle), length(Length::kShank), 1e-3);
  EXPECT_NEAR(distance(Landmark::kLeftShoulder, Landmark::kRightShoulder),
              length(Length::kShoulders), 1e-3);
  EXPECT_NEAR(distance(Landmark::kLeftHip, Landmark::kRightHip), length(Length::kHips), 1e-3);
  EXPECT_NEAR(distance(Landmark::kLeftElbow, Landmark::kLeftWrist), length(Length::kLowerArm),
              1e-3);
  EXPECT_NEAR(distance(Landmark::kLeftEar, Landmark::kRightEar), length(Length::kEars), 1e-3);
  EXPECT_TRUE(is_valid(shape.skeleton));
  // Soles on the floor in T-pose.
  BodyState standing;
  standing.p_WH_m = {0.0, static_cast<double>(shape.skeleton.hips_height_m()), 0.0};
  model.place(shape, standing);
  EXPECT_NEAR(model.point(point_of(Sole::kLeftBall)).y(), 0.0, 1e-5);
  EXPECT_NEAR(model.point(point_of(Sole::kRightHeel)).y(), 0.0, 1e-5);
}

}  // namespace
}  // namespace dance
