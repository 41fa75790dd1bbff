// What is shown of a dancer: never below the floor, never turned faster than a body, hands still
// while they are still.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "producers/camera/solver/shown/facing.h"
#include "tests/allocation_guard.h"
#include "tests/producers/camera/solver/seen_dance.h"

namespace dance {
namespace {

constexpr double kTurn_rad = 2.0 * std::numbers::pi;

struct Shown {
  double lowest_m = 1.0;       // of a sole, in all pictures
  double highest_low_m = 0.0;  // of the lower foot's sole
  double fastest_deg_s = 0.0;
  std::vector<double> facing_rad;
  std::vector<double> hand_steps_m;  // of both, from the sixth second on
  int without_pose = 0;
};

Shown shown_of(const CaptureScene& scene, const SolverOptions& options) {
  BodySolver solver(options, scene.camera.pinhole);
  Shown shown;
  Pose pose;
  MonoTime shown_at;
  std::array<Eigen::Vector3f, 2> hands{Eigen::Vector3f::Zero(), Eigen::Vector3f::Zero()};
  for (std::size_t f = 0; f < scene.frames.size(); ++f) {
    if (!solver.solve(scene.frames[f].landmarks, {}, pose)) {
      ++shown.without_pose;
      continue;
    }
    EXPECT_TRUE(is_valid(pose)) << f;
    BodyFrames frames;
    forward_kinematics(solver.skeleton(), pose, frames);
    const double low_m = lowest_sole_m(solver.skeleton(), frames);
    shown.lowest_m = std::min(shown.lowest_m, low_m);
    shown.highest_low_m = std::max(shown.highest_low_m, low_m);
    const std::optional<double> facing = facing_of(solver.skeleton(), pose);
    if (facing && !shown.facing_rad.empty())
      shown.fastest_deg_s = std::max(
          shown.fastest_deg_s, std::abs(turn_between(shown.facing_rad.back(), facing)) /
                                   (pose.capture_time - shown_at).as_seconds() * 360.0 / kTurn_rad);
    shown_at = pose.capture_time;
    shown.facing_rad.push_back(facing.value_or(0.0));
    const std::array now{frames.position(Bone::kLeftHand), frames.position(Bone::kRightHand)};
    for (std::size_t s = 0; s < 2 && f > 180; ++s)
      shown.hand_steps_m.push_back(static_cast<double>((now[s] - hands[s]).norm()));
    hands = now;
  }
  std::sort(shown.hand_steps_m.begin(), shown.hand_steps_m.end());
  return shown;
}

std::vector<Pose> turned(std::vector<Pose> poses, double angle_rad, double speed_rad_s = 0.0) {
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const double angle = angle_rad + speed_rad_s * static_cast<double>(i) / kSeenHz;
    const Eigen::Quaternionf R(
        Eigen::AngleAxisf(static_cast<float>(angle), Eigen::Vector3f::UnitY()));
    poses[i].p_WH_m = R * poses[i].p_WH_m;
    poses[i].R_PB[0] = (R * poses[i].R_PB[0]).normalized();
  }
  return poses;
}

CaptureScene scene_of(const std::vector<Pose>& poses, const SceneErrors& errors,
                      const SceneCamera& camera = {}, std::uint64_t seed = 7) {
  return make_scene("turned", salsa_skeleton(), poses, kSeenHz, camera, errors, seed);
}

SolverOptions uncorrected() {
  SolverOptions options;
  options.keeps_above_floor = options.limits_facing = options.steadies_hands = false;
  return options;
}

TEST(ShownBody, NoSoleIsBelowTheFloorFromTheFirstPictureOn) {
  double worst_m = 0.0;
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    SceneCamera camera;
    camera.height_m = 0.8 + 0.15 * static_cast<double>(seed);
    const CaptureScene scene =
        scene_of(turned(salsa_poses(3.0), static_cast<double>(seed)), SceneErrors(), camera, seed);
    const Shown shown = shown_of(scene, {});
    EXPECT_GT(shown.lowest_m, -0.005) << seed;
    // On it, not over it.
    EXPECT_LT(shown.highest_low_m, 0.15) << seed;
    worst_m = std::min(worst_m, shown_of(scene, uncorrected()).lowest_m);
  }
  EXPECT_LT(worst_m, -0.02);
}

TEST(ShownBody, StandsOnTheFloorWhereItsLegsAreOutOfThePicture) {
  SceneErrors errors;
  errors.hides_outside = true;
  SceneCamera camera;
  camera.distance_m = 1.7;
  camera.height_m = 1.3;
  camera.pitch_rad = 0.0;
  const CaptureScene scene = scene_of(salsa_poses(4.0), errors, camera);
  const Shown shown = shown_of(scene, {});
  EXPECT_EQ(shown.without_pose, 0);
  EXPECT_GT(shown.lowest_m, -0.005);
  EXPECT_LT(shown.highest_low_m, 0.15);
  EXPECT_LT(shown_of(scene, uncorrected()).lowest_m, -0.05);
}

double furthest_rad(const Shown& a, const Shown& b) {
  double furthest = 0.0;
  for (std::size_t f = 0; f < std::min(a.facing_rad.size(), b.facing_rad.size()); ++f)
    furthest = std::max(furthest, std::abs(turn_between(a.facing_rad[f], b.facing_rad[f])));
  return furthest;
}

TEST(ShownBody, ABackThatIsTakenForAFrontIsNotShown) {
  const std::vector<Pose> poses = turned(salsa_poses(8.0), 2.8);
  SceneErrors errors;
  errors.flips_per_s = 1.5;
  errors.flip_for_s = 0.2;
  const CaptureScene scene = scene_of(poses, errors);
  ASSERT_GT(std::count_if(scene.frames.begin(), scene.frames.end(),
                          [](const SceneFrame& frame) { return frame.is_flipped; }),
            10);
  const Shown truth = shown_of(scene_of(poses, SceneErrors()), {}), shown = shown_of(scene, {});
  EXPECT_LE(shown.fastest_deg_s, 720.0);
  EXPECT_LT(furthest_rad(truth, shown), 0.5);
  EXPECT_GT(furthest_rad(truth, shown_of(scene, uncorrected())), 0.6);
}

// From a picture on, the network has the other facing for good.
TEST(ShownBody, AFacingThatLastsIsTurnedToAtABodysSpeed) {
  const std::vector<Pose> still(static_cast<std::size_t>(8.0 * kSeenHz), standing());
  SceneErrors errors;
  errors.hidden_per_s = 0.0;
  CaptureScene scene = scene_of(still, errors);
  const CaptureScene back = scene_of(turned(still, 0.5 * kTurn_rad), errors);
  constexpr std::size_t kAt = 120;
  for (std::size_t f = kAt; f < scene.frames.size(); ++f) {
    scene.frames[f].landmarks.image_px = back.frames[f].landmarks.image_px;
    scene.frames[f].landmarks.world_m = back.frames[f].landmarks.world_m;
  }
  const Shown shown = shown_of(scene, {}), plain = shown_of(scene, uncorrected());
  EXPECT_LE(shown.fastest_deg_s, 720.0);
  const auto off = [](const Shown& of, std::size_t f) {
    return std::abs(turn_between(0.0, of.facing_rad[f]));
  };
  EXPECT_LT(off(shown, kAt + 9), 0.6);
  EXPECT_GT(off(shown, kAt + 45), 2.5);
  EXPECT_GT(off(plain, kAt + 9), 0.7);
}

// Lost for 0.2 s, and detected again with the back taken for a front.
TEST(ShownBody, AFlipInTheFirstPictureAfterALossIsNotShown) {
  const std::vector<Pose> still(static_cast<std::size_t>(6.0 * kSeenHz),
                                turned({standing()}, 2.9).front());
  SceneErrors errors;
  errors.hidden_per_s = 0.0;
  CaptureScene scene = scene_of(still, errors);
  const CaptureScene front = scene_of(turned(still, 0.5 * kTurn_rad), errors);
  constexpr std::size_t kAt = 120;
  for (std::size_t f = kAt; f < kAt + 6; ++f) scene.frames[f].landmarks.found = false;
  scene.frames[kAt + 6].landmarks.is_new = true;
  for (std::size_t f = kAt + 6; f < kAt + 18; ++f) {
    scene.frames[f].landmarks.image_px = front.frames[f].landmarks.image_px;
    scene.frames[f].landmarks.world_m = front.frames[f].landmarks.world_m;
  }
  const auto most_off = [](const Shown& shown) {
    double most = 0.0;
    for (std::size_t f = 60; f < shown.facing_rad.size(); ++f)
      most = std::max(most, std::abs(turn_between(2.9, shown.facing_rad[f])));
    return most;
  };
  EXPECT_LT(most_off(shown_of(scene, {})), 0.5);
  EXPECT_GT(most_off(shown_of(scene, uncorrected())), 0.8);
}

// At other rates, with pictures without a body, and with another dancer afterwards.
TEST(ShownBody, KeepsItsBoundsAtOtherRatesAndAfterGaps) {
  SceneErrors errors;
  errors.flips_per_s = 1.0;
  for (const double hz : {15.0, 60.0}) {
    SalsaDancer dancer{SalsaStyle()};
    std::vector<Pose> poses(static_cast<std::size_t>(5.0 * hz));
    for (std::size_t f = 0; f < poses.size(); ++f)
      dancer.dance_at(Duration::seconds(static_cast<double>(f) / hz), poses[f]);
    CaptureScene scene =
        make_scene("salsa", salsa_skeleton(), turned(poses, 2.5), hz, SceneCamera(), errors, 5);
    const auto gap = [&scene](double from_s, double to_s) {
      for (SceneFrame& frame : scene.frames) {
        const double t = (frame.landmarks.capture_time - MonoTime()).as_seconds() - 1.0;
        frame.landmarks.found = frame.landmarks.found && !(t > from_s && t < to_s);
      }
    };
    gap(1.5, 1.8);
    gap(2.4, 3.3);
    const Shown shown = shown_of(scene, {});
    EXPECT_GT(shown.without_pose, 0) << hz;
    EXPECT_GT(shown.lowest_m, -0.005) << hz;
    EXPECT_LE(shown.fastest_deg_s, 720.0) << hz;
  }
  // Another dancer, whose bones and floor are not those of the first.
  const CaptureScene first = scene_of(salsa_poses(3.0), SceneErrors()),
                     second = make_scene("small", average_skeleton(), salsa_poses(2.0), kSeenHz,
                                         SceneCamera(), SceneErrors(), 9);
  BodySolver solver({}, first.camera.pinhole);
  Pose pose;
  for (const SceneFrame& frame : first.frames) solver.solve(frame.landmarks, {}, pose);
  solver.reset();
  int shown = 0;
  for (const SceneFrame& frame : second.frames) {
    BodyLandmarks seen = frame.landmarks;
    seen.capture_time = seen.capture_time + Duration::s(4);
    if (!solver.solve(seen, {}, pose)) continue;
    BodyFrames frames;
    forward_kinematics(solver.skeleton(), pose, frames);
    EXPECT_GT(lowest_sole_m(solver.skeleton(), frames), -0.005) << shown;
    ++shown;
  }
  EXPECT_GT(shown, 50);
}

TEST(ShownBody, FastSpinsPass) {
  // Standing for two seconds, then three turns in two: 540 degrees a second.
  std::vector<Pose> poses(static_cast<std::size_t>(2.0 * kSeenHz), standing());
  const std::vector<Pose> spin = turned(
      std::vector<Pose>(static_cast<std::size_t>(2.0 * kSeenHz), standing()), 0.0, 1.5 * kTurn_rad);
  poses.insert(poses.end(), spin.begin(), spin.end());
  SceneErrors errors;
  errors.hidden_per_s = 0.0;
  const CaptureScene scene = scene_of(poses, errors);
  const Shown shown = shown_of(scene, {}), plain = shown_of(scene, uncorrected());
  const double frame_rad = 1.5 * kTurn_rad / kSeenHz;
  double worst = 0.0, plain_worst = 0.0;
  for (std::size_t i = 15; i < spin.size(); ++i) {
    const double truth = frame_rad * static_cast<double>(i);
    worst = std::max(worst, std::abs(turn_between(truth, shown.facing_rad[60 + i])));
    plain_worst = std::max(plain_worst, std::abs(turn_between(truth, plain.facing_rad[60 + i])));
  }
  EXPECT_GT(shown.fastest_deg_s, 500.0);
  EXPECT_LT(plain_worst, 0.7);
  EXPECT_LT(worst, plain_worst + 0.5 * frame_rad);
}

TEST(ShownBody, HandsThatAreStillDoNotTremble) {
  const std::vector<Pose> poses(static_cast<std::size_t>(14.0 * kSeenHz), standing());
  SceneErrors errors;
  errors.hidden_per_s = 0.0;
  const CaptureScene scene = scene_of(poses, errors);
  const auto p99 = [](const Shown& shown) {
    return shown.hand_steps_m[shown.hand_steps_m.size() * 99 / 100];
  };
  EXPECT_LT(p99(shown_of(scene, {})), 0.008);
  EXPECT_GT(p99(shown_of(scene, uncorrected())), 0.02);
}

TEST(ShownBody, AllocatesNothingWhileFlipsAreRefused) {
  SceneErrors errors;
  errors.flips_per_s = 2.0;
  const CaptureScene scene = scene_of(turned(salsa_poses(5.0), 2.8), errors);
  BodySolver solver({}, scene.camera.pinhole);
  Pose pose;
  solver.solve(scene.frames[0].landmarks, {}, pose);
  const AllocationGuard guard;
  for (std::size_t f = 1; f < scene.frames.size(); ++f)
    solver.solve(scene.frames[f].landmarks, {}, pose);
  EXPECT_EQ(guard.allocations(), 0u);
}

}  // namespace
}  // namespace dance
