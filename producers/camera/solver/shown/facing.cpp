#include "producers/camera/solver/shown/facing.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "producers/camera/solver/body_vectors.h"

namespace dance {

using Eigen::Vector2d;
using Eigen::Vector3d;

namespace {

// Of the sum of two vectors of length 1.
constexpr double kLeastAcross = 0.5;
constexpr double kTorsoSeen = 0.3;
// The network's facing differs by less from the expected one, however fast a dancer spins.
constexpr double kMostSurprise_rad = 0.9;
constexpr double kUsualStep_s = 1.0 / 30.0;
// A turn by more is looked at closely: sides exchanged, or depth reversed, explain it where the
// body's vectors are then by so much nearer to the expected ones.
constexpr double kSuspect_rad = 0.4, kExplains = 0.4;
// A flip that lasts longer is taken for a turn; sooner where nothing explains it.
constexpr double kLasting_s = 0.8, kUnexplained_s = 0.4;
// A believed turn that is seen undone for so long; one picture may be wrong.
constexpr double kUndoneFor_s = 0.1, kUndoneWithin_s = 3.0, kUndone_rad = 0.9;
constexpr double kBehind_rad = 0.15;
// Rays that are further off, in standard deviations, count as much as these.
constexpr double kMostOff = 10.0;

// How far a body may have turned since it was seen, beyond what is usual between pictures.
double unseen_turn_rad(double unseen_s) {
  return FacingLimit::kFastest_rad_s * std::max(0.0, unseen_s - kUsualStep_s);
}

// The same point of the other side.
constexpr std::size_t other_side(std::size_t i) {
  if (i == index_of(Landmark::kNose)) return i;
  if (i >= index_of(Landmark::kLeftEar)) return i % 2 ? i + 1 : i - 1;
  return i < index_of(Landmark::kRightEyeInner) ? i + 3 : i - 3;
}

// Of the directions of the body's vectors, weighted.
double vector_distance(const Observation& seen, const Eigen::Matrix3d& R_WC,
                       const BodyModel& body) {
  double sum = 0.0, weights = 1e-9;
  for (const BodyVector& v : kBodyVectors) {
    const std::size_t fa = point_of(v.from_a), fb = point_of(v.from_b), ta = point_of(v.to_a),
                      tb = point_of(v.to_b);
    const double weight = std::min({seen.world_weight[fa], seen.world_weight[fb],
                                    seen.world_weight[ta], seen.world_weight[tb]}) /
                          (v.sd * v.sd);
    const Vector3d is =
        R_WC * (seen.world_m[ta] + seen.world_m[tb] - seen.world_m[fa] - seen.world_m[fb]);
    const Vector3d due = body.point(ta) + body.point(tb) - body.point(fa) - body.point(fb);
    const double size = is.norm() * due.norm();
    if (!(weight > 0.0) || !(size > 1e-6)) continue;
    sum += weight * (1.0 - is.dot(due) / size);
    weights += weight;
  }
  return sum / weights;
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
  for (const Landmark l :
       {Landmark::kLeftHip, Landmark::kRightHip, Landmark::kLeftShoulder, Landmark::kRightShoulder})
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

std::optional<Observation> without_flip(const Observation& seen, const Eigen::Matrix3d& R_WC,
                                        const BodyModel& expected) {
  std::optional<Observation> best;
  double least = kExplains * vector_distance(seen, R_WC, expected);
  for (const bool exchanges : {true, false})
    for (const bool reverses : {true, false}) {
      if (!exchanges && !reverses) continue;
      Observation other = seen;
      if (exchanges) exchange_sides(other);
      for (std::size_t i = 0; reverses && i < kLandmarkCount; ++i)
        other.world_m[i].z() = -other.world_m[i].z();
      const double distance = vector_distance(other, R_WC, expected);
      if (!(distance < least)) continue;
      least = distance;
      best = other;
    }
  return best;
}

bool FlipWatch::is_suspect(double turn_rad, double unseen_s) {
  return std::abs(turn_rad) > kSuspect_rad + unseen_turn_rad(unseen_s);
}

bool FlipWatch::is_far(double turn_rad, double unseen_s) {
  return std::abs(turn_rad) > kMostSurprise_rad + unseen_turn_rad(unseen_s);
}

FacingVerdict FlipWatch::judge(const std::optional<double>& seen_rad, double turn_rad, bool is_far,
                               bool is_explained, double seconds, double unseen_s) {
  since_jump_s_ += seconds;
  if (since_jump_s_ > kUndoneWithin_s) jump_rad_.reset();
  has_jumped_ = has_jumped_ || FlipWatch::is_far(turn_between(seen_rad_, seen_rad), unseen_s);
  if (seen_rad) seen_rad_ = seen_rad;
  // Where what is seen did not jump, the body turned, and the expectation is behind.
  if (!is_far || !(has_jumped_ || is_explained)) {
    has_jumped_ = is_far && has_jumped_;
    // One picture that agrees does not prove that those before were wrong.
    refused_s_ = std::max(0.0, refused_s_ - seconds);
    // While the body was not seen it may have turned so far, or the network may be wrong.
    if (!is_far && std::abs(turn_rad) > kMostSurprise_rad) believe(turn_rad);
    return FacingVerdict::kPlausible;
  }
  const bool is_undone = jump_rad_ && std::abs(turn_between(-*jump_rad_, turn_rad)) < kUndone_rad;
  refused_s_ += seconds;
  const double lasting_s = is_undone ? kUndoneFor_s : is_explained ? kLasting_s : kUnexplained_s;
  if (refused_s_ < lasting_s) return FacingVerdict::kRefused;
  has_jumped_ = false;
  refused_s_ = 0.0;
  believe(turn_rad);
  if (is_undone) jump_rad_.reset();
  return FacingVerdict::kLasting;
}

void FlipWatch::believe(double turn_rad) {
  jump_rad_ = turn_rad;
  since_jump_s_ = 0.0;
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
  } else {
    const double most = kFastest_rad_s * seconds;
    offset_rad_ -= std::clamp(offset_rad_, -most, most);
  }
  if (offset_rad_ != 0.0) turn_about_vertical(offset_rad_, pose);
}

bool FacingLimit::is_behind() const { return std::abs(offset_rad_) > kBehind_rad; }

}  // namespace dance
