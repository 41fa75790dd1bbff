#include "producers/camera/solver/body_fit.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <bit>
#include <cmath>

#include "producers/camera/solver/body_vectors.h"

namespace dance {

using Eigen::Matrix3d;
using Eigen::Quaterniond;
using Eigen::Vector2d;
using Eigen::Vector3d;
using Row = Eigen::Matrix<double, 1, dof::kCount>;

namespace {

// Rays with larger residuals, in standard deviations, are down-weighted.
constexpr double kOutlier = 4.0;
// The same for the prediction.
constexpr double kSurprise = 3.0;
// Of a sole that stands, above the floor and beside where it is held; of one that is below the
// floor.
constexpr double kFloorSd_m = 0.008, kHeldSd_m = 0.015, kBelowSd_m = 0.01;
constexpr double kDamping = 1e-3;
// Points closer to the camera's plane than this have no usable ray.
constexpr double kNearest_m = 0.2;
// A posture in which less of the seen weight is in front of the cameras is refused.
constexpr double kLeastInFront = 0.5;
// No joint turns further in one iteration.
constexpr double kMostStep = 0.7;

}  // namespace

BodyState state_at_ease() {
  BodyState state;
  for (std::size_t s = 0; s < 2; ++s) {
    const double sign = s == 0 ? 1.0 : -1.0;
    BodyState::Side& side = state.sides[s];
    side.upper_arm = turn_of(Vector3d(0.0, 0.0, -sign * 1.25));
    side.elbow = 0.35;
    side.knee = 0.1;
  }
  return state;
}

void BodyFit::add_row(const Row& row, std::uint64_t moved, double residual, double weight) {
  std::array<int, dof::kCount> columns;
  std::array<double, dof::kCount> values;
  int count = 0;
  for (; moved != 0; moved &= moved - 1) {
    const int column = std::countr_zero(moved);
    columns[static_cast<std::size_t>(count)] = column;
    values[static_cast<std::size_t>(count++)] = row[column];
  }
  for (int i = 0; i < count; ++i) {
    const double scaled = weight * values[static_cast<std::size_t>(i)];
    const int column = columns[static_cast<std::size_t>(i)];
    gradient_[column] += scaled * residual;
    // The lower half of a symmetric matrix: columns come in rising order.
    for (int j = i; j < count; ++j)
      normal_(columns[static_cast<std::size_t>(j)], column) +=
          scaled * values[static_cast<std::size_t>(j)];
  }
  cost_ += 0.5 * weight * residual * residual;
}

void BodyFit::add_rays(const Eye& eye, bool trusting) {
  const Observation& seen = *eye.seen;
  for (std::size_t i = 0; i < kLandmarkCount; ++i) {
    if (seen.weight[i] <= 0.0) continue;
    Vector3d p_W = model_.point(i);
    if (eye.moved_W_m) p_W -= (*eye.moved_W_m)[i];
    const Vector3d p = eye.R_VW * (p_W - eye.p_WV_m);
    weight_seen_ += seen.weight[i];
    if (p.z() < kNearest_m) continue;
    weight_in_front_ += seen.weight[i];
    const Vector2d residual(p.x() / p.z() - seen.ray[i].x(), p.y() / p.z() - seen.ray[i].y());
    double weight = eye.trust * seen.weight[i] / eye.variance;
    if (!trusting) weight /= 1.0 + residual.squaredNorm() / (kOutlier * kOutlier * eye.variance);
    const PointJacobian& J = model_.jacobian(i);
    for (int axis = 0; axis < 2; ++axis) {
      // d(x/z) = (dx − (x/z) dz) / z
      const Vector3d direction =
          (eye.R_VW.row(axis) - p[axis] / p.z() * eye.R_VW.row(2)).transpose() / p.z();
      const Row row = direction.transpose() * J;
      add_row(row, model_.moved_by(i), residual[axis], weight);
    }
  }
}

void BodyFit::add_vectors(const Eye& eye) {
  const Observation& seen = *eye.seen;
  const Matrix3d R_WV = eye.R_VW.transpose();
  for (const BodyVector& v : kBodyVectors) {
    const std::size_t fa = point_of(v.from_a), fb = point_of(v.from_b), ta = point_of(v.to_a),
                      tb = point_of(v.to_b);
    const double weight = eye.trust * std::min({seen.world_weight[fa], seen.world_weight[fb],
                                                seen.world_weight[ta], seen.world_weight[tb]});
    if (weight <= 0.0) continue;
    const Vector3d measured =
        seen.world_m[ta] + seen.world_m[tb] - seen.world_m[fa] - seen.world_m[fb];
    const double measured_m = measured.norm();
    const Vector3d has =
        0.5 * (model_.point(ta) + model_.point(tb) - model_.point(fa) - model_.point(fb));
    const double has_m = has.norm();
    if (measured_m < 1e-3 || has_m < 1e-3) continue;
    const Vector3d residual = has - R_WV * measured * (has_m / measured_m);
    const double sd = v.sd * has_m;
    const std::uint64_t moved =
        model_.moved_by(ta) | model_.moved_by(tb) | model_.moved_by(fa) | model_.moved_by(fb);
    for (int axis = 0; axis < 3; ++axis) {
      const Row row = 0.5 * (model_.jacobian(ta).row(axis) + model_.jacobian(tb).row(axis) -
                             model_.jacobian(fa).row(axis) - model_.jacobian(fb).row(axis));
      add_row(row, moved, residual[axis], weight / (sd * sd));
    }
  }
}

void BodyFit::add_eyes(const FitProblem& problem, bool trusting) {
  std::array<Eye, 1 + kMostOtherViews> eyes;
  const CameraPlacement& camera = *problem.camera;
  const Matrix3d R_CW = camera.R_WC().transpose();
  eyes[0] = {problem.seen,
             R_CW,
             camera.to_W(Vector3d::Zero()),
             problem.seen->ray_sd * problem.seen->ray_sd,
             1.0,
             nullptr};
  std::size_t count = 1;
  for (std::size_t i = 0; i < problem.other_count; ++i) {
    const OtherView& other = problem.others[i].view;
    const double variance =
        other.seen.ray_sd * other.seen.ray_sd + other.placement_sd * other.placement_sd;
    eyes[count++] = {
        &other.seen, other.R_VC * R_CW, camera.to_W(-(other.R_VC.transpose() * other.p_VC_m)),
        variance,    other.trust,       &problem.others[i].moved_W_m};
  }
  for (std::size_t i = 0; i < count; ++i) add_rays(eyes[i], trusting);
  for (std::size_t i = 0; i < count; ++i) add_vectors(eyes[i]);
}

void BodyFit::add_expectation(const FitProblem& problem, const BodyState& state) {
  static const BodyState ease = state_at_ease();
  const DofVector off = step_between(problem.expected.state, state);
  DofVector strained = step_between(ease, state);
  strained.head<6>().setZero();
  // Dancers change direction suddenly: a prediction that is far off is down-weighted.
  const DofVector precision =
      (problem.expected.precision.array() /
       (1.0 + off.array().square() * problem.expected.precision.array() / (kSurprise * kSurprise)))
          .matrix();
  const DofVector pull = precision.cwiseProduct(off),
                  ease_pull = problem.expected.ease.cwiseProduct(strained);
  normal_.diagonal() += precision + problem.expected.ease;
  gradient_ += pull + ease_pull;
  cost_ += 0.5 * (pull.dot(off) + ease_pull.dot(strained));
}

void BodyFit::add_soles(const FitProblem& problem) {
  if (!problem.has_floor) return;
  for (std::size_t i = 0; i < kSoleCount; ++i) {
    const std::size_t point = kLandmarkCount + i;
    const Vector3d& p = model_.point(point);
    const PointJacobian& J = model_.jacobian(point);
    const SoleTouch& sole = problem.soles[i];
    if (sole.stands) {
      const Vector3d off = p - sole.held_W_m;
      for (int axis = 0; axis < 3; ++axis) {
        const double sd = axis == 1 ? kFloorSd_m : kHeldSd_m;
        add_row(J.row(axis), model_.moved_by(point), axis == 1 ? p.y() : off[axis],
                1.0 / (sd * sd));
      }
    } else if (p.y() < 0.0) {
      add_row(J.row(1), model_.moved_by(point), p.y(), 1.0 / (kBelowSd_m * kBelowSd_m));
    }
  }
}

void BodyFit::add_depth(const FitProblem& problem) {
  if (!problem.depth) return;
  const std::size_t left = point_of(Landmark::kLeftHip), right = point_of(Landmark::kRightHip);
  const Vector3d middle = 0.5 * (model_.point(left) + model_.point(right));
  const Vector3d along = problem.camera->R_WC().col(2);
  const Row row = 0.5 * along.transpose() * (model_.jacobian(left) + model_.jacobian(right));
  const double sd = std::max(0.005, problem.depth->spread_m);
  add_row(row, model_.moved_by(left) | model_.moved_by(right),
          problem.camera->to_C(middle).z() - problem.depth->hips_depth_m, 1.0 / (sd * sd));
}

void BodyFit::build(const FitProblem& problem, bool trusting, const BodyState& state) {
  model_.place(*problem.shape, state);
  model_.differentiate();
  normal_.setZero();
  gradient_.setZero();
  cost_ = weight_in_front_ = weight_seen_ = 0.0;
  add_eyes(problem, trusting);
  picture_cost_ = cost_;
  add_expectation(problem, state);
  add_soles(problem);
  add_depth(problem);
}

void BodyFit::hold_ends(const BodyState& state) {
  const auto hold = [this](int column) {
    normal_.row(column).setZero();
    normal_.col(column).setZero();
    normal_(column, column) = 1.0;
    gradient_[column] = 0.0;
  };
  for (int s = 0; s < 2; ++s) {
    const BodyState::Side& side = state.sides[static_cast<std::size_t>(s)];
    const int elbow = dof::side(s) + dof::kElbow, knee = dof::side(s) + dof::kKnee;
    if (side.elbow <= 0.0 && gradient_[elbow] > 0.0) hold(elbow);
    if (side.knee <= 0.0 && gradient_[knee] > 0.0) hold(knee);
    if (side.elbow >= kMostElbow_rad && gradient_[elbow] < 0.0) hold(elbow);
    if (side.knee >= kMostKnee_rad && gradient_[knee] < 0.0) hold(knee);
  }
}

bool BodyFit::solve(const FitProblem& problem, int rounds, int trusting, BodyState& state) {
  BodyState better = state;
  for (int round = 0; round < rounds; ++round) {
    build(problem, round < trusting, better);
    hold_ends(better);
    normal_.diagonal() *= 1.0 + kDamping;
    normal_.diagonal().array() += 1e-6;
    DofVector step = -normal_.selfadjointView<Eigen::Lower>().ldlt().solve(gradient_);
    if (!step.allFinite()) return false;
    step.tail<dof::kCount - 3>() =
        step.tail<dof::kCount - 3>().cwiseMax(-kMostStep).cwiseMin(kMostStep);
    const double moved_m = step.head<3>().norm();
    if (moved_m > 1.0) step.head<3>() /= moved_m;
    move(better, step);
  }
  build(problem, false, better);
  // Points behind the camera cost nothing: without this, a body behind it would fit every picture.
  if (!std::isfinite(cost_) || weight_in_front_ < kLeastInFront * weight_seen_) return false;
  state = better;
  return true;
}

}  // namespace dance
