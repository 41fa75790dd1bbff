#include "producers/camera/solver/body_solver.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/base/random.h"
#include "producers/camera/solver/body_fit.h"
#include "tests/allocation_guard.h"
#include "tests/producers/camera/solver/seen_dance.h"

namespace dance {
namespace {

double error_before_camera_m(const CaptureScene& scene, const SolverOptions& options,
                             std::size_t from) {
  BodySolver solver(options, scene.camera.pinhole);
  Pose pose;
  double sum = 0.0;
  for (std::size_t f = 0; f < scene.frames.size(); ++f) {
    EXPECT_TRUE(solver.solve(scene.frames[f].landmarks, {}, pose));
    // A body that does not move does not tell its own leaning from the camera's: what counts here
    // is the body before the camera.
    const double lean_rad = solver.camera_stand().pitch_rad - scene.camera.pitch_rad;
    if (f >= from) sum += joint_error_m(scene.frames[f], solver.skeleton(), pose, lean_rad);
  }
  return sum / static_cast<double>(scene.frames.size() - from);
}

TEST(BodySolver, FindsATPoseThatIsSeenWithoutErrors) {
  EXPECT_LT(error_before_camera_m(still_scene(Pose(), 5.0, no_errors()), {}, 120), 0.015);
}

TEST(BodySolver, FindsPosturesThatAreSeenWithoutErrors) {
  Random random(21);
  for (int round = 0; round < 8; ++round) {
    BodyState state = state_at_ease();
    DofVector step;
    for (int i = 0; i < dof::kCount; ++i) step[i] = 0.4 * random.uniform(-1.0, 1.0);
    step.segment<3>(dof::kPlace).setZero();
    step.segment<6>(dof::kHips) *= 0.5;
    step[dof::kHips + 1] = random.uniform(-1.2, 1.2);
    move(state, step);
    for (auto& side : state.sides) side.elbow = random.uniform(0.2, 1.8);
    Pose pose;
    write_pose(state, pose);
    SolverOptions options;
    options.holds_feet = false;  // they are nowhere near a floor
    EXPECT_LT(error_before_camera_m(still_scene(pose, 4.0, no_errors()), options, 110), 0.05)
        << round;
  }
}

TEST(BodySolver, IsNearerToTheDanceThanTheNetwork) {
  const CaptureScene scene = salsa_scene(8.0, SceneErrors());
  double network_m = 0.0;
  for (std::size_t f = 120; f < scene.frames.size(); ++f) {
    const BodyLandmarks& l = scene.frames[f].landmarks;
    const auto& truth = scene.frames[f].truth_W_m;
    const Eigen::Vector3d hips =
        0.5 * (truth[index_of(Landmark::kLeftHip)] + truth[index_of(Landmark::kRightHip)]);
    for (const auto& joint : kLimbJoints)
      network_m += (scene.R_WC * l.world(joint.landmark).cast<double>() -
                    (truth[index_of(joint.landmark)] - hips))
                       .norm() /
                   static_cast<double>(kLimbJoints.size());
  }
  network_m /= static_cast<double>(scene.frames.size() - 120);
  EXPECT_LT(error_before_camera_m(scene, {}, 120), 0.92 * network_m);
}

TEST(BodySolver, BonesAreLearnedAndThenHeld) {
  const CaptureScene scene = salsa_scene(10.0, SceneErrors());
  BodySolver solver({}, scene.camera.pinhole);
  Pose pose;
  std::uint32_t changes = 0, version = solver.skeleton().version;
  for (std::size_t f = 0; f < scene.frames.size(); ++f) {
    const Skeleton before = solver.skeleton();
    solver.solve(scene.frames[f].landmarks, {}, pose);
    if (solver.skeleton().version != version) {
      ++changes;
      version = solver.skeleton().version;
      EXPECT_LT(f, 220u);
    } else {
      EXPECT_EQ(before, solver.skeleton());
    }
    EXPECT_TRUE(is_valid(solver.skeleton()));
  }
  EXPECT_EQ(changes, 2u);
  EXPECT_TRUE(solver.is_settled());
  // The network's metres are 3 % short here.
  const Skeleton truth = salsa_skeleton();
  for (const Bone bone :
       {Bone::kLeftLowerArm, Bone::kLeftHand, Bone::kLeftLowerLeg, Bone::kLeftFoot}) {
    const float ratio = solver.skeleton().offset(bone).norm() / truth.offset(bone).norm();
    EXPECT_NEAR(ratio, 0.97f, 0.05f) << kBones[index_of(bone)].name;
  }
}

TEST(BodySolver, ADancerIsAsTallAsTold) {
  const CaptureScene scene = salsa_scene(5.0, SceneErrors());
  SolverOptions options;
  options.height_m = 1.91;
  BodySolver solver(options, scene.camera.pinhole);
  EXPECT_NEAR(standing_height_m(solver.skeleton()), 1.91f, 0.01f);
  Pose pose;
  for (const SceneFrame& frame : scene.frames) solver.solve(frame.landmarks, {}, pose);
  EXPECT_NEAR(standing_height_m(solver.skeleton()), 1.91f, 0.02f);
}

TEST(BodySolver, ASecondEyeTellsTheScale) {
  const CaptureScene scene = salsa_scene(5.0, SceneErrors());
  BodySolver alone({}, scene.camera.pinhole), helped({}, scene.camera.pinhole);
  Pose pose;
  for (const SceneFrame& frame : scene.frames) {
    alone.solve(frame.landmarks, {}, pose);
    DepthHint hint;
    const Eigen::Vector3d hips = 0.5 * (frame.truth_W_m[index_of(Landmark::kLeftHip)] +
                                        frame.truth_W_m[index_of(Landmark::kRightHip)]);
    hint.hips_depth_m = (scene.R_WC.transpose() * (hips - scene.p_WC_m)).z();
    hint.spread_m = 0.02;
    hint.scale = 1.0 / 0.97;
    hint.scale_spread = 0.02;
    hint.joints = 10;
    helped.solve(frame.landmarks, hint, pose);
  }
  EXPECT_NEAR(standing_height_m(helped.skeleton()) / standing_height_m(alone.skeleton()),
              1.0f / 0.97f, 1e-3f);
}

TEST(BodySolver, KneesAndElbowsNeverBendBackwards) {
  const CaptureScene scene = salsa_scene(8.0, SceneErrors());
  BodySolver solver({}, scene.camera.pinhole);
  Pose pose;
  for (const SceneFrame& frame : scene.frames) {
    ASSERT_TRUE(solver.solve(frame.landmarks, {}, pose));
    for (const Bone knee : {Bone::kLeftLowerLeg, Bone::kRightLowerLeg}) {
      const Eigen::Vector3f shank = pose.R_PB[index_of(knee)] * -Eigen::Vector3f::UnitY();
      EXPECT_LT(shank.z(), 0.1f);
    }
    const Eigen::Vector3f left =
        pose.R_PB[index_of(Bone::kLeftLowerArm)] * Eigen::Vector3f::UnitX();
    const Eigen::Vector3f right =
        pose.R_PB[index_of(Bone::kRightLowerArm)] * -Eigen::Vector3f::UnitX();
    EXPECT_GT(left.z(), -0.1f);
    EXPECT_GT(right.z(), -0.1f);
  }
}

TEST(BodySolver, WhatIsHiddenIsCarriedAndComesBackWithoutAJump) {
  SceneErrors errors = no_errors();
  CaptureScene scene = salsa_scene(9.0, errors);
  constexpr std::size_t kFrom = 150, kTo = 180;
  BodySolver solver({}, scene.camera.pinhole), seeing({}, scene.camera.pinhole);
  Pose pose, seen_pose;
  Eigen::Vector3f before = Eigen::Vector3f::Zero(), seen_before = before;
  float furthest_m = 0.0f, seen_furthest_m = 0.0f;
  bool was_absent = false;
  for (std::size_t f = 0; f < scene.frames.size(); ++f) {
    BodyLandmarks landmarks = scene.frames[f].landmarks;
    ASSERT_TRUE(seeing.solve(landmarks, {}, seen_pose));
    if (f >= kFrom && f < kTo)
      for (const Landmark l : {Landmark::kLeftElbow, Landmark::kLeftWrist, Landmark::kLeftPinky,
                               Landmark::kLeftIndex, Landmark::kLeftThumb}) {
        landmarks.visibility[index_of(l)] = 0.05f;
        // What a network says of what it cannot see.
        landmarks.image_px[index_of(l)] += Eigen::Vector3f(f % 2 ? 90.0f : -90.0f, 120.0f, 0.0f);
        landmarks.world_m[index_of(l)] += Eigen::Vector3f(0.0f, f % 2 ? 0.3f : -0.3f, 0.2f);
      }
    ASSERT_TRUE(solver.solve(landmarks, {}, pose));
    const bool is_there = (pose.presence >> index_of(Bone::kLeftLowerArm) & 1u) != 0;
    if (f == kFrom + 5) {
      EXPECT_TRUE(is_there);
    }
    was_absent = was_absent || !is_there;
    BodyFrames frames;
    forward_kinematics(solver.skeleton(), pose, frames);
    const Eigen::Vector3f hand = frames.position(Bone::kLeftHand);
    forward_kinematics(seeing.skeleton(), seen_pose, frames);
    const Eigen::Vector3f seen_hand = frames.position(Bone::kLeftHand);
    if (f >= kFrom) {
      furthest_m = std::max(furthest_m, (hand - before).norm());
      seen_furthest_m = std::max(seen_furthest_m, (seen_hand - seen_before).norm());
    }
    before = hand;
    seen_before = seen_hand;
    if (f >= kTo + 45) {
      EXPECT_LT((hand - seen_hand).norm(), 0.05f);
      EXPECT_TRUE(is_there);
    }
  }
  EXPECT_TRUE(was_absent);
  // On the way back a hand moves at most as fast as joints are taken back: 6 m/s, beside the dance
  // itself.
  EXPECT_LT(furthest_m, seen_furthest_m + 0.2f);
}

TEST(BodySolver, AMirrorShowsTheSameDanceOnTheOtherSide) {
  const CaptureScene scene = salsa_scene(4.0, SceneErrors());
  SolverOptions mirrored;
  mirrored.is_mirrored = true;
  BodySolver plain({}, scene.camera.pinhole), mirror_solver(mirrored, scene.camera.pinhole);
  Pose a, b;
  for (const SceneFrame& frame : scene.frames) {
    ASSERT_TRUE(plain.solve(frame.landmarks, {}, a));
    ASSERT_TRUE(mirror_solver.solve(frame.landmarks, {}, b));
    mirror(b);
    for (std::size_t i = 0; i < kBoneCount; ++i)
      ASSERT_LT(a.R_PB[i].angularDistance(b.R_PB[i]), 1e-3f);
    ASSERT_LT((a.p_WH_m - b.p_WH_m).norm(), 1e-6f);
  }
}

TEST(BodySolver, FindsTheFloorAndStandsOnIt) {
  SceneCamera camera;
  camera.height_m = 1.5;
  camera.pitch_rad = 0.15;
  const CaptureScene scene = salsa_scene(20.0, SceneErrors(), camera);
  BodySolver solver({}, scene.camera.pinhole);
  Pose pose;
  for (std::size_t f = 0; f < scene.frames.size(); ++f) {
    ASSERT_TRUE(solver.solve(scene.frames[f].landmarks, {}, pose));
    if (f < 150) continue;
    BodyFrames frames;
    forward_kinematics(solver.skeleton(), pose, frames);
    EXPECT_GT(frames.tip(Tip::kLeftToes).y(), -0.01f);
    EXPECT_GT(frames.tip(Tip::kRightToes).y(), -0.01f);
    EXPECT_LT(std::min(frames.tip(Tip::kLeftToes).y(), frames.tip(Tip::kRightToes).y()), 0.12f);
  }
  EXPECT_TRUE(solver.camera_stand().is_settled);
  EXPECT_NEAR(solver.camera_stand().height_m, 1.5, 0.25);
  EXPECT_NEAR(solver.camera_stand().pitch_rad, 0.15, 0.06);
  EXPECT_LT(pose.p_WH_m.head<3>().norm(), 3.0f);
}

TEST(BodySolver, WhoLeavesIsGoneAfterHalfASecondAndComesBack) {
  const CaptureScene scene = salsa_scene(9.0, SceneErrors());
  BodySolver solver({}, scene.camera.pinhole);
  Pose pose;
  for (std::size_t f = 0; f < scene.frames.size(); ++f) {
    BodyLandmarks landmarks = scene.frames[f].landmarks;
    const bool is_away = f >= 120 && f < 160;
    if (is_away) {
      landmarks = BodyLandmarks();
      landmarks.capture_time = scene.frames[f].landmarks.capture_time;
    }
    landmarks.is_new = landmarks.is_new || f == 160;
    const bool is_there = solver.solve(landmarks, {}, pose);
    if (!is_away || f < 130) {
      EXPECT_TRUE(is_there) << f;
    } else if (f > 137) {
      EXPECT_FALSE(is_there) << f;
    }
    if (is_there) {
      EXPECT_TRUE(is_valid(pose));
    }
    if (f > 200) {
      EXPECT_LT(joint_error_m(scene.frames[f], solver.skeleton(), pose), 0.25);
    }
  }
  const std::uint32_t version = solver.skeleton().version;
  solver.reset();
  EXPECT_GT(solver.skeleton().version, version);
  EXPECT_FALSE(solver.is_settled());
}

TEST(BodySolver, AllocatesNothingPerPicture) {
  const CaptureScene scene = salsa_scene(6.0, SceneErrors());
  BodySolver solver({}, scene.camera.pinhole);
  Pose pose;
  solver.solve(scene.frames[0].landmarks, {}, pose);
  const AllocationGuard guard;
  for (std::size_t f = 1; f < scene.frames.size(); ++f) {
    BodyLandmarks landmarks = scene.frames[f].landmarks;
    if (f % 40 > 30) landmarks.found = false;
    landmarks.is_new = f % 50 == 0;
    solver.solve(landmarks, {}, pose);
  }
  EXPECT_EQ(guard.allocations(), 0u);
}

TEST(BodySolver, OldPicturesAreRefused) {
  const CaptureScene scene = salsa_scene(1.0, SceneErrors());
  BodySolver solver({}, scene.camera.pinhole);
  Pose pose;
  EXPECT_TRUE(solver.solve(scene.frames[5].landmarks, {}, pose));
  const Pose kept = pose;
  EXPECT_FALSE(solver.solve(scene.frames[5].landmarks, {}, pose));
  EXPECT_FALSE(solver.solve(scene.frames[2].landmarks, {}, pose));
  EXPECT_EQ(pose.capture_time, kept.capture_time);
  EXPECT_TRUE(solver.solve(scene.frames[6].landmarks, {}, pose));
}

// What a broken network, or a hostile picture, might say.
void spoil(BodyLandmarks& landmarks, int kind, Random& random) {
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  constexpr float kInf = std::numeric_limits<float>::infinity();
  for (std::size_t i = 0; i < kLandmarkCount; ++i) {
    switch (kind) {
      case 0:
        landmarks.image_px[i].setConstant(kNan);
        break;
      case 1:
        landmarks.world_m[i].setConstant(i % 2 ? kNan : kInf);
        break;
      case 2:
        landmarks.visibility[i] = 0.0f;
        break;
      case 3:
        landmarks.image_px[i] = {640.0f, 360.0f, 0.0f};
        break;
      case 4:
        landmarks.world_m[i].setZero();
        break;
      case 5:
        landmarks.image_px[i] *= 1e20f;
        break;
      case 6:
        landmarks.world_m[i] *= -3.0f;
        break;
      case 7:
        landmarks.visibility[i] = i % 3 ? kNan : 1e9f;
        break;
      case 8:
        landmarks.image_px[i] = {static_cast<float>(1280.0 * random.uniform()),
                                 static_cast<float>(720.0 * random.uniform()), 0.0f};
        break;
      case 9:
        landmarks.world_m[i] = {static_cast<float>(random.normal()),
                                static_cast<float>(random.normal()),
                                static_cast<float>(random.normal())};
        break;
      case 10:
        landmarks.image_px[i] = {640.0f, 360.0f, 0.0f};
        landmarks.world_m[i].setZero();
        break;
      default:
        landmarks.region.side_px = kNan;
        break;
    }
  }
}

TEST(BodySolver, HostileLandmarksNeverGiveAnInvalidPose) {
  const CaptureScene scene = salsa_scene(7.0, SceneErrors());
  for (int kind = 0; kind < 12; ++kind) {
    for (const bool from_begin : {true, false}) {
      Random random(static_cast<std::uint64_t>(31 + kind));
      BodySolver solver({}, scene.camera.pinhole);
      Pose pose;
      int valid = 0;
      for (std::size_t f = 0; f < scene.frames.size(); ++f) {
        BodyLandmarks landmarks = scene.frames[f].landmarks;
        const bool is_bad = from_begin ? f < 60 : f % 20 < 7 && f + 30 < scene.frames.size();
        if (is_bad) spoil(landmarks, kind, random);
        std::optional<DepthHint> hint;
        if (f % 5 == 0) {
          hint = DepthHint{};
          hint->joints = 3;
          hint->hips_depth_m = f % 10 ? std::numeric_limits<double>::quiet_NaN() : -4.0;
          hint->scale = f % 15 ? 0.0 : std::numeric_limits<double>::infinity();
        }
        if (!solver.solve(landmarks, hint, pose)) continue;
        ++valid;
        ASSERT_TRUE(is_valid(pose)) << "kind " << kind << ", frame " << f;
        ASSERT_LT(pose.p_WH_m.norm(), 100.0f) << "kind " << kind << ", frame " << f;
      }
      EXPECT_GT(valid, 60) << "kind " << kind;
      EXPECT_TRUE(is_valid(solver.skeleton()));
      // It recovers.
      EXPECT_LT(joint_error_m(scene.frames.back(), solver.skeleton(), pose), 0.4)
          << "kind " << kind;
    }
  }
}

TEST(BodySolver, RecoversWithinTwoSecondsFromRandomImagePoints) {
  const CaptureScene scene = salsa_scene(7.0, SceneErrors());
  double sum_m = 0.0;
  constexpr int kSeeds = 10;
  for (int seed = 0; seed < kSeeds; ++seed) {
    Random random(static_cast<std::uint64_t>(1000 + seed));
    BodySolver solver({}, scene.camera.pinhole);
    Pose pose;
    for (std::size_t f = 0; f < scene.frames.size(); ++f) {
      BodyLandmarks landmarks = scene.frames[f].landmarks;
      if (f % 20 < 7 && f + 60 < scene.frames.size()) spoil(landmarks, 8, random);
      solver.solve(landmarks, {}, pose);
    }
    const double error_m = joint_error_m(scene.frames.back(), solver.skeleton(), pose);
    EXPECT_LT(error_m, 0.35) << "seed " << seed;
    sum_m += error_m;
  }
  // Backs wound up by whole turns, and bodies behind the camera, made this 0.34.
  EXPECT_LT(sum_m / kSeeds, 0.25);
}

}  // namespace
}  // namespace dance
