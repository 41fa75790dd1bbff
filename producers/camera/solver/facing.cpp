#include "producers/camera/solver/facing.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "producers/camera/solver/camera_placement.h"

namespace dance {

using Eigen::Vector2d;
using Eigen::Vector3d;

namespace {

// Of the sum of two vectors of length 1.
constexpr double kLeastAcross = 0.5;
constexpr double kTorsoSeen = 0.3;
// The network's facing differs by less from the expected one, however fast a dancer spins.
constexpr double kMostSurprise_rad = 1.3;
constexpr double kUsualStep_s = 1.0 / 30.0;
// A flip that lasts longer is taken for a turn. Shown at a body's speed it needs as long again.
constexpr double kLasting_s = 0.4;
constexpr double kBehind_rad = 0.15;
// Rays that are further off, in standard deviations, count as much as these.
constexpr double kMostOff = 10.0;

// The same point of the other side.
constexpr std::size_t other_side(std::size_t i) {
  if (i == index_of(Landmark::kNose)) return i;
  if (i >= index_of(Landmark::kLeftEar)) return i % 2 ? i + 1 : i - 1;
  return i < index_of(Landmark::kRightEyeInner) ? i + 3 : i - 3;
}

}  // namespace

double turn_between(const std::optional<double>& from_rad, const std::optional<double>& to_rad) {
  return from_rad && to_rad ? std::remainder(*to_rad - *from_rad, 2.0 * std::numbers::pi) : 0.0;
}

void turn_about_vertical(double angle_rad, Pose& pose) {
  const Eigen::Quaternionf R(
      Eigen::AngleAxisf(static_cast<float>(angle_rad), Eigen::Vector3f::UnitY()));
  Eigen::Quaternionf& hips = pose.R_PB[index_of(Bone::kHips)];
  hips = (R * hips).normalized();
}

std::optional<double> facing_of(const Vector3d& hips, const Vector3d& shoulders) {
  const Vector3d across = hips.normalized() + shoulders.normalized();
  // Also false for NaN.
  if (!(std::hypot(across.x(), across.z()) > kLeastAcross)) return std::nullopt;
  return std::atan2(-across.z(), across.x());
}

std::optional<double> facing_of(const BodyModel& body) {
  return facing_of(body.point(Landmark::kLeftHip) - body.point(Landmark::kRightHip),
                   body.point(Landmark::kLeftShoulder) - body.point(Landmark::kRightShoulder));
}

std::optional<double> facing_of(const Skeleton& skeleton, const Pose& pose) {
  BodyFrames frames;
  forward_kinematics(skeleton, pose, frames);
  const auto across = [&frames](Bone left, Bone right) {
    return Vector3d((frames.position(left) - frames.position(right)).cast<double>());
  };
  return facing_of(across(Bone::kLeftUpperLeg, Bone::kRightUpperLeg),
                   across(Bone::kLeftUpperArm, Bone::kRightUpperArm));
}

std::optional<double> facing_of(const Observation& seen, const Eigen::Matrix3d& R_WC) {
  for (const Landmark l : {Landmark::kLeftHip, Landmark::kRightHip, Landmark::kLeftShoulder,
                           Landmark::kRightShoulder})
    if (seen.world_weight[index_of(l)] < kTorsoSeen) return std::nullopt;
  return facing_of(
      R_WC * (seen.world(Landmark::kLeftHip) - seen.world(Landmark::kRightHip)),
      R_WC * (seen.world(Landmark::kLeftShoulder) - seen.world(Landmark::kRightShoulder)));
}

void exchange_sides(Observation& seen) {
  for (std::size_t i = 0; i < kLandmarkCount; ++i) {
    const std::size_t other = other_side(i);
    if (other <= i) continue;
    std::swap(seen.ray[i], seen.ray[other]);
    std::swap(seen.weight[i], seen.weight[other]);
    std::swap(seen.world_m[i], seen.world_m[other]);
    std::swap(seen.world_weight[i], seen.world_weight[other]);
  }
}

double ray_distance(const Observation& seen, const BodyModel& body, const CameraPlacement& camera) {
  double sum = 0.0;
  for (std::size_t i = 0; i < kLandmarkCount; ++i) {
    if (seen.weight[i] <= 0.0) continue;
    const Vector3d p = camera.to_C(body.point(i));
    if (p.z() < 0.2) continue;
    const double off =
        Vector2d(p.x() / p.z() - seen.ray[i].x(), p.y() / p.z() - seen.ray[i].y()).norm();
    sum += seen.weight[i] * std::min(off / seen.ray_sd, kMostOff);
  }
  return sum;
}

FacingVerdict FlipWatch::judge(const std::optional<double>& seen_rad,
                               const std::optional<double>& expected_rad, double seconds,
                               double unseen_s) {
  const double unseen_turn =
      FacingLimit::kFastest_rad_s * std::max(0.0, unseen_s - kUsualStep_s);
  if (std::abs(turn_between(expected_rad, seen_rad)) < kMostSurprise_rad + unseen_turn) {
    refused_s_ = 0.0;
    return FacingVerdict::kPlausible;
  }
  refused_s_ += seconds;
  if (refused_s_ < kLasting_s) return FacingVerdict::kRefused;
  refused_s_ = 0.0;
  return FacingVerdict::kLasting;
}

void FacingLimit::apply(const Skeleton& skeleton, double seconds, Pose& pose) {
  const std::optional<double> given = facing_of(skeleton, pose);
  since_s_ += seconds;
  if (given) {
    double facing = *given;
    if (shown_rad_) {
      const double most = kFastest_rad_s * since_s_;
      facing = *shown_rad_ + std::clamp(turn_between(shown_rad_, given), -most, most);
    }
    shown_rad_ = facing;
    since_s_ = 0.0;
    offset_rad_ = turn_between(given, facing);
  }
  if (offset_rad_ != 0.0) turn_about_vertical(offset_rad_, pose);
}

bool FacingLimit::is_behind() const { return std::abs(offset_rad_) > kBehind_rad; }

}  // namespace dance
