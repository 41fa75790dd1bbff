#include "producers/camera/solver/camera_placement.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace dance {

using Eigen::Matrix3d;
using Eigen::Vector3d;

namespace {

// Standard deviations of the prior for a camera's placement, and of one observation.
constexpr double kLean = 0.03, kTilt = 0.15, kHeight_m = 0.6;
constexpr double kUpright = 0.06, kUprightAside = 0.04;
constexpr double kFoot = 0.015;
// Observations of one standing foot are correlated: so many count as one.
constexpr double kSame = 8.0;
constexpr double kMostWeight = 3600.0 / kSame;
constexpr double kGuess_m = 0.15;
constexpr int kMostRefused = 60;
constexpr double kMostLean = 0.3, kMostTilt = 1.0, kLeastHeight_m = 0.1, kMostHeight_m = 5.0;

}  // namespace

void CameraPlacement::reset() {
  discard_feet();
  up_sum_C_.setZero();
  ups_ = 0;
  initial_h_m_ = 1.2;
  plane_ = {1.2, 0.0, 0.0};
  origin_C_m_ = {0.0, 1.2, 3.0};
  place();
}

void CameraPlacement::discard_feet() {
  feet_information_.setZero();
  feet_sum_.setZero();
  feet_weight_ = 0.0;
  feet_ = refused_ = 0;
}

void CameraPlacement::relearn_floor() {
  initial_h_m_ = plane_[0];
  discard_feet();
}

void CameraPlacement::add_upright(const Vector3d& up_C) {
  const double norm = up_C.norm();
  // A body that lies or bends does not show what is upright.
  if (!(norm > 0.3) || up_C.y() > -0.7 * norm) return;
  const double keep = ups_ < 300 ? 1.0 : 1.0 - 1.0 / 300.0;
  up_sum_C_ = keep * up_sum_C_ + up_C / norm;
  ++ups_;
}

void CameraPlacement::add_foot(const Vector3d& p) {
  if (!p.allFinite() || !(p.z() > 0.5) || !(p.z() < 20.0)) return;
  const Vector3d row(1.0 / p.z(), p.x() / p.z(), 1.0);
  const double seen = p.y() / p.z();
  // Feet on a table or an outlier: the floor cannot be there.
  if (is_known() && std::abs(row.dot(plane_) - seen) > 6.0 * kFoot) {
    // So many in a row: the floor was wrong, or the camera was moved.
    if (++refused_ > kMostRefused) discard_feet();
    return;
  }
  refused_ = 0;
  const double keep = feet_weight_ < kMostWeight ? 1.0 : 1.0 - 1.0 / (kSame * kMostWeight);
  feet_information_ = keep * feet_information_ + row * row.transpose() / kSame;
  feet_sum_ = keep * feet_sum_ + row * seen / kSame;
  feet_weight_ = keep * feet_weight_ + 1.0 / kSame;
  feet_ = std::min(feet_ + 1, kSettled);
}

void CameraPlacement::set_initial_floor(const Vector3d& lowest_C_m) {
  const double h = lowest_C_m.y() - plane_[1] * lowest_C_m.x() - plane_[2] * lowest_C_m.z();
  initial_h_m_ = std::clamp(h, kLeastHeight_m, kMostHeight_m);
}

std::optional<double> CameraPlacement::growth_to_floor(const Vector3d& p) const {
  const double under = p.y() - plane_[1] * p.x() - plane_[2] * p.z();
  if (!(under > 0.1)) return std::nullopt;
  return plane_[0] / under;
}

void CameraPlacement::scale(double by) {
  // h alone has a unit.
  const Vector3d unit(1.0 / by, 1.0, 1.0);
  feet_information_ = unit.asDiagonal() * feet_information_ * unit.asDiagonal();
  feet_sum_ = unit.asDiagonal() * feet_sum_;
  initial_h_m_ *= by;
  plane_[0] *= by;
  origin_C_m_ *= by;
  place();
}

void CameraPlacement::update() {
  Matrix3d A = feet_information_ / (kFoot * kFoot);
  Vector3d b = feet_sum_ / (kFoot * kFoot);
  const auto expect = [&](int i, double value, double sd) {
    A(i, i) += 1.0 / (sd * sd);
    b[i] += value / (sd * sd);
  };
  expect(0, 1.2, kHeight_m);
  expect(1, 0.0, kLean);
  expect(2, 0.0, kTilt);
  if (feet_ < kKnown) expect(0, initial_h_m_, kGuess_m);
  if (ups_ > 0 && up_sum_C_.y() < 0.0) {
    // up is along (a, −1, b)
    expect(1, up_sum_C_.x() / -up_sum_C_.y(), kUprightAside);
    expect(2, up_sum_C_.z() / -up_sum_C_.y(), kUpright);
  }
  const Vector3d plane = A.ldlt().solve(b);
  if (!plane.allFinite()) return;
  plane_ = {std::clamp(plane[0], kLeastHeight_m, kMostHeight_m),
            std::clamp(plane[1], -kMostLean, kMostLean),
            std::clamp(plane[2], -kMostTilt, kMostTilt)};
  place();
}

double CameraPlacement::pitch_rad() const { return -std::atan(plane_[2]); }

void CameraPlacement::place() {
  const Vector3d normal(plane_[1], -1.0, plane_[2]);
  const Vector3d up = normal.normalized();
  height_m_ = plane_[0] / normal.norm();
  // +z comes towards the camera along the floor.
  Vector3d towards = -Vector3d::UnitZ();
  towards -= up * up.dot(towards);
  towards.normalize();
  R_WC_.row(0) = up.cross(towards).transpose();
  R_WC_.row(1) = up.transpose();
  R_WC_.row(2) = towards.transpose();
  const Vector3d foot = origin_C_m_ - up * (up.dot(origin_C_m_) + height_m_);
  p_WC_m_ = -(R_WC_ * foot);
}

}  // namespace dance
