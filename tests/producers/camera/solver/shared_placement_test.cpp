// Two dancers before one camera: one floor, one W.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <optional>

#include "producers/camera/solver/body_solver.h"
#include "tests/producers/camera/solver/seen_dance.h"

namespace dance {
namespace {

// Two dancers before one camera, the second half a metre behind and to the right, in pictures from
// `second_from` on. Returns where each stands in the one W at the end, and how tall.
struct Pair {
  std::array<double, 2> sole_m{};  // height of the lowest sole, mean of the last second
  double apart_m = 0.0;            // of their hips, along the view
  double true_apart_m = 0.0;
  std::array<double, 2> height_m{}, true_height_m{};
};
Pair pair_on_one_floor(std::optional<double> first_m, std::optional<double> second_m,
                       std::size_t second_from, bool resets_first = false) {
  std::array<CaptureScene, 2> scenes;
  SceneCamera camera;
  camera.middle_m = Eigen::Vector3d(0.0, 0.0, 0.0);
  for (std::size_t i = 0; i < 2; ++i) {
    SalsaStyle style;
    style.role = i == 0 ? SalsaRole::kLead : SalsaRole::kFollow;
    SalsaDancer dancer(style);
    std::vector<Pose> poses(static_cast<std::size_t>(14.0 * kSeenHz));
    for (std::size_t f = 0; f < poses.size(); ++f) {
      dancer.dance_at(Duration::seconds(static_cast<double>(f) / kSeenHz), poses[f]);
      poses[f].p_WH_m.x() += i == 0 ? -0.6f : 0.6f;
      poses[f].p_WH_m.z() += i == 0 ? 0.0f : -0.5f;
    }
    scenes[i] = make_scene("pair", dancer.skeleton(), poses, kSeenHz, camera, {}, 11 + i);
  }
  const auto shared = make_shared_placement();
  std::array<SolverOptions, 2> options;
  options[0].height_m = first_m;
  options[1].height_m = second_m;
  std::vector<BodySolver> solvers;
  for (const SolverOptions& o : options) solvers.emplace_back(o, camera.pinhole, shared);
  Pair pair;
  double count = 0.0;
  for (std::size_t f = 0; f < scenes[0].frames.size(); ++f) {
    std::array<Pose, 2> poses;
    if (resets_first && f == 250) solvers[0].reset();
    for (std::size_t i = 0; i < 2; ++i) {
      BodyLandmarks seen = scenes[i].frames[f].landmarks;
      if (i == 1 && f < second_from) seen.found = false;
      if (i == 1 && f == second_from) seen.is_new = true;
      solvers[i].solve(seen, std::nullopt, poses[i]);
    }
    if (f + 30 < scenes[0].frames.size()) continue;
    count += 1.0;
    for (std::size_t i = 0; i < 2; ++i) {
      BodyFrames body;
      forward_kinematics(solvers[i].skeleton(), poses[i], body);
      pair.sole_m[i] += lowest_sole_m(solvers[i].skeleton(), body);
    }
    pair.apart_m += static_cast<double>(poses[0].p_WH_m.z() - poses[1].p_WH_m.z());
    const auto depth = [&](std::size_t i) {
      const CaptureScene& scene = scenes[i];
      const auto& truth = scene.frames[f].truth_W_m;
      return (0.5 * (truth[index_of(Landmark::kLeftHip)] + truth[index_of(Landmark::kRightHip)]) -
              scene.p_WC_m)
          .z();
    };
    pair.true_apart_m += depth(0) - depth(1);
  }
  for (std::size_t i = 0; i < 2; ++i) {
    pair.sole_m[i] /= count;
    pair.height_m[i] = static_cast<double>(standing_height_m(solvers[i].skeleton()));
    pair.true_height_m[i] = scenes[i].height_m;
  }
  pair.apart_m /= count;
  pair.true_apart_m /= count;
  return pair;
}

void expect_on_one_floor(const Pair& pair, double height_within) {
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_LT(std::abs(pair.sole_m[i]), 0.05) << i;
    EXPECT_NEAR(pair.height_m[i] / pair.true_height_m[i], 1.0, height_within) << i;
  }
  // Of what is the same share of every length.
  const double scale = pair.height_m[0] / pair.true_height_m[0];
  EXPECT_NEAR(pair.apart_m, scale * pair.true_apart_m, 0.25);
}

TEST(SharedPlacement, TwoWhoseHeightsAreToldStandOnOneFloor) {
  const double lead = static_cast<double>(standing_height_m(salsa_skeleton(SalsaRole::kLead, 1))),
               follow =
                   static_cast<double>(standing_height_m(salsa_skeleton(SalsaRole::kFollow, 1)));
  expect_on_one_floor(pair_on_one_floor(lead, follow, 0), 0.03);
}

TEST(SharedPlacement, TheSecondIsAsTallAsTheFloorSays) {
  const double lead = static_cast<double>(standing_height_m(salsa_skeleton(SalsaRole::kLead, 1)));
  for (const std::size_t late : {0u, 120u})
    expect_on_one_floor(pair_on_one_floor(lead, std::nullopt, late), 0.06);
}

TEST(SharedPlacement, OneWhoseHeightWasToldSetsTheScaleOnceSeen) {
  const double follow =
      static_cast<double>(standing_height_m(salsa_skeleton(SalsaRole::kFollow, 1)));
  expect_on_one_floor(pair_on_one_floor(std::nullopt, follow, 60), 0.1);
}

TEST(SharedPlacement, WhenTheFirstIsMeasuredAgainTheFloorStays) {
  expect_on_one_floor(pair_on_one_floor(std::nullopt, std::nullopt, 0, true), 0.12);
}

}  // namespace
}  // namespace dance
