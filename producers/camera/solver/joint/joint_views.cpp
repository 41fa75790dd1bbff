#include "producers/camera/solver/joint/joint_views.h"

#include <algorithm>
#include <cmath>

#include "producers/camera/solver/shown/facing.h"

namespace dance {

using Eigen::Matrix3d;
using Eigen::Vector3d;

namespace {

// Facings that two cameras agree on differ by less.
constexpr double kSameFacing_rad = 0.35;
// A hand that a second camera sees so well is measured along the first one's view too.
constexpr double kHandSeen = 0.3;
constexpr double kLeastAcross_m = 0.003;

void drop_view(FitProblem& problem, std::size_t i) {
  --problem.other_count;
  for (; i < problem.other_count; ++i) problem.others[i] = problem.others[i + 1];
}

Matrix3d R_WV(const FitProblem& problem, std::size_t i) {
  return problem.camera->R_WC() * problem.others[i].view.R_VC.transpose();
}

// False where the body cannot face as the view has it.
bool mend_facing(const FitProblem& problem, std::size_t i, double unseen_s, const BodyModel& model,
                 Observation& seen) {
  const Matrix3d R = R_WV(problem, i);
  const std::optional<double> expected_rad = facing_of(model), seen_rad = facing_of(seen, R);
  const double turn_rad = turn_between(expected_rad, seen_rad);
  if (!FlipWatch::is_suspect(turn_rad, unseen_s)) return true;
  if (const auto corrected = without_flip(seen, R, model)) {
    seen = *corrected;
    return true;
  }
  if (!FlipWatch::is_far(turn_rad, unseen_s)) return true;
  const std::optional<double> first_rad = facing_of(*problem.seen, problem.camera->R_WC());
  return first_rad && std::abs(turn_between(first_rad, seen_rad)) < kSameFacing_rad;
}

}  // namespace

void take_views(OtherViews views, FitProblem& problem) {
  problem.other_count = 0;
  for (const OtherView& view : views) {
    if (problem.other_count == kMostOtherViews) return;
    if (!view.seen.is_usable || !(view.trust > 0.0) || !(std::abs(view.older_s) <= kOldestView_s))
      continue;
    FitView& taken = problem.others[problem.other_count++];
    taken.view = view;
    taken.moved_W_m.fill(Vector3d::Zero());
  }
}

void align_views(const MotionFilter& motion, const Expectation& expected, const BodyShape& shape,
                 double unseen_s, BodyModel& model, FitProblem& problem) {
  model.place(shape, expected.state);
  for (std::size_t i = 0; i < problem.other_count;) {
    if (mend_facing(problem, i, unseen_s, model, problem.others[i].view.seen))
      ++i;
    else
      drop_view(problem, i);
  }
  for (std::size_t i = 0; i < problem.other_count; ++i) {
    FitView& other = problem.others[i];
    model.place(shape, motion.before(expected, other.view.older_s));
    for (std::size_t p = 0; p < kLandmarkCount; ++p) other.moved_W_m[p] = -model.point(p);
  }
  model.place(shape, expected.state);
  for (std::size_t i = 0; i < problem.other_count; ++i)
    for (std::size_t p = 0; p < kLandmarkCount; ++p)
      problem.others[i].moved_W_m[p] += model.point(p);
}

Observation merged(const FitProblem& problem) {
  Observation all = *problem.seen;
  if (problem.other_count == 0) return all;
  for (std::size_t p = 0; p < kLandmarkCount; ++p) {
    double sum = all.world_weight[p];
    all.world_m[p] *= sum;
    for (std::size_t i = 0; i < problem.other_count; ++i) {
      const OtherView& other = problem.others[i].view;
      const double weight = other.trust * other.seen.world_weight[p];
      all.world_m[p] += weight * (other.R_VC.transpose() * other.seen.world_m[p]);
      sum += weight;
      all.world_weight[p] = std::max(all.world_weight[p], weight);
      all.weight[p] = std::max(all.weight[p], other.trust * other.seen.weight[p]);
    }
    if (sum > 0.0) all.world_m[p] /= sum;
  }
  for (std::size_t i = 0; i < problem.other_count; ++i) {
    const OtherView& other = problem.others[i].view;
    all.is_usable = all.is_usable || other.seen.is_usable;
    all.visible = std::max(all.visible, other.trust * other.seen.visible);
  }
  return all;
}

bool place_on_all_rays(const FitProblem& problem,
                       const std::array<Vector3d, kLandmarkCount>& relative_C_m,
                       Vector3d& place_C_m) {
  RayPlace place;
  place.add(*problem.seen, Matrix3d::Identity(), Vector3d::Zero(), 1.0, relative_C_m);
  const Matrix3d R_CW = problem.camera->R_WC().transpose();
  for (std::size_t i = 0; i < problem.other_count; ++i) {
    const FitView& other = problem.others[i];
    std::array<Vector3d, kLandmarkCount> then_C_m = relative_C_m;
    for (std::size_t p = 0; p < kLandmarkCount; ++p) then_C_m[p] -= R_CW * other.moved_W_m[p];
    place.add(other.view.seen, other.view.R_VC, other.view.p_VC_m, other.view.trust, then_C_m);
  }
  return place.solve(place_C_m);
}

SteadyHands::Measurement hand_measurement(const FitProblem& problem,
                                          const PartVisibility& visibility,
                                          const Vector3d& hips_W_m) {
  SteadyHands::Measurement measurement;
  const Vector3d eye_W_m = problem.camera->to_W(Vector3d::Zero());
  measurement.eye_W_m = eye_W_m.cast<float>();
  const double across_m =
      std::max(kLeastAcross_m, problem.seen->ray_sd * (hips_W_m - eye_W_m).norm());
  measurement.across_sd_m = static_cast<float>(across_m);
  for (std::size_t s = 0; s < 2; ++s) {
    measurement.visibility[s] = static_cast<float>(
        visibility[static_cast<std::size_t>(s == 0 ? Part::kArmLeft : Part::kArmRight)]);
    const std::size_t wrist = index_of(Landmark::kLeftWrist) + s;
    if (problem.seen->weight[wrist] < kHandSeen) continue;
    for (std::size_t i = 0; i < problem.other_count; ++i) {
      const OtherView& other = problem.others[i].view;
      if (other.trust * other.seen.weight[wrist] < kHandSeen) continue;
      const Vector3d other_W_m = problem.camera->to_W(-(other.R_VC.transpose() * other.p_VC_m));
      const Vector3d to = (hips_W_m - eye_W_m).normalized(),
                     other_to = (hips_W_m - other_W_m).normalized();
      const double sine = to.cross(other_to).norm();
      const auto along_m = static_cast<float>(across_m / std::max(0.05, sine));
      measurement.along_sd_m[s] = std::min(measurement.along_sd_m[s], along_m);
    }
  }
  return measurement;
}

}  // namespace dance
