#include "producers/camera/solver/observation.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace dance {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

namespace {

// Visibilities at which a point's weight begins and is full.
constexpr double kHidden = 0.2, kSeen = 0.65;
// Points outside the picture are extrapolated by the network.
constexpr double kMargin = 0.02;
// Share of the region's side, of one coordinate; hands and feet are seen less well.
constexpr double kPointSd = 0.004;
constexpr double kLeastSd_px = 0.7;
constexpr double kFurthestPoint_m = 5.0;
constexpr float kFurthestPoint_px = 1e6f;

constexpr std::array kJoints{
    Landmark::kLeftShoulder, Landmark::kRightShoulder, Landmark::kLeftElbow, Landmark::kRightElbow,
    Landmark::kLeftWrist,    Landmark::kRightWrist,    Landmark::kLeftHip,   Landmark::kRightHip,
    Landmark::kLeftKnee,     Landmark::kRightKnee,     Landmark::kLeftAnkle, Landmark::kRightAnkle};

// The network's points of the hand and the eyes are less certain than those of joints.
double trust(std::size_t i) {
  const auto l = static_cast<Landmark>(i);
  if (l >= Landmark::kLeftPinky && l <= Landmark::kRightThumb) return 0.4;
  if (l <= Landmark::kMouthRight) return 0.5;
  return 1.0;
}

// Inverse of OpenCV's distortion by fixed point, which converges for every lens that is not a
// fisheye.
Vector2d undistorted(const Pinhole& camera, const Vector2d& pixel) {
  const Vector2d seen((pixel.x() - camera.cx_px) / camera.fx_px,
                      (pixel.y() - camera.cy_px) / camera.fy_px);
  const auto& d = camera.distortion;
  if (d == std::array<double, 5>{}) return seen;
  Vector2d p = seen;
  for (int i = 0; i < 8; ++i) {
    const double r2 = p.squaredNorm();
    const double radial = 1.0 + r2 * (d[0] + r2 * (d[1] + r2 * d[4]));
    const Vector2d aside(2.0 * d[2] * p.x() * p.y() + d[3] * (r2 + 2.0 * p.x() * p.x()),
                         d[2] * (r2 + 2.0 * p.y() * p.y()) + 2.0 * d[3] * p.x() * p.y());
    p = (seen - aside) / std::max(radial, 0.2);
  }
  return p.allFinite() ? p : seen;
}

double side_of_region_px(const BodyLandmarks& landmarks) {
  const double side = static_cast<double>(landmarks.region.side_px);
  if (side > 1.0 && side < static_cast<double>(kFurthestPoint_px)) return side;
  float low = kFurthestPoint_px, high = -kFurthestPoint_px;
  for (const auto& p : landmarks.image_px) {
    if (!p.allFinite()) continue;
    low = std::min(low, p.y());
    high = std::max(high, p.y());
  }
  return std::max(50.0, 1.25 * static_cast<double>(high - low));
}

}  // namespace

Observation observe(const BodyLandmarks& landmarks, const Pinhole& camera) {
  Observation seen;
  const double margin_x = kMargin * camera.width_px, margin_y = kMargin * camera.height_px;
  for (std::size_t i = 0; i < kLandmarkCount; ++i) {
    const Eigen::Vector3f& image = landmarks.image_px[i];
    const Eigen::Vector3f& world = landmarks.world_m[i];
    const auto visibility = static_cast<double>(landmarks.visibility[i]);
    seen.ray[i].setZero();
    seen.world_m[i].setZero();
    if (!landmarks.found || !(visibility > kHidden)) continue;
    const double weight =
        trust(i) * std::clamp((visibility - kHidden) / (kSeen - kHidden), 0.0, 1.0);
    if (world.allFinite() && static_cast<double>(world.norm()) < kFurthestPoint_m) {
      seen.world_m[i] = world.cast<double>();
      seen.world_weight[i] = weight;
    }
    if (!image.head<2>().allFinite() || image.head<2>().cwiseAbs().maxCoeff() > kFurthestPoint_px)
      continue;
    // A Pinhole counts from the middle of the first pixel, landmarks from its corner.
    const Vector2d pixel = image.head<2>().cast<double>().array() - 0.5;
    seen.ray[i] = undistorted(camera, pixel);
    if (pixel.x() > -margin_x && pixel.x() < camera.width_px + margin_x && pixel.y() > -margin_y &&
        pixel.y() < camera.height_px + margin_y)
      seen.weight[i] = weight;
  }
  seen.ray_sd = std::max(kLeastSd_px, kPointSd * side_of_region_px(landmarks)) / camera.fy_px;
  int usable = 0;
  for (const Landmark joint : kJoints) {
    const double weight = std::min(seen.weight_of(joint), seen.world_weight[index_of(joint)]);
    seen.visible += weight / static_cast<double>(kJoints.size());
    usable += weight > 0.2 ? 1 : 0;
  }
  const double torso = (seen.world(Landmark::kLeftShoulder) + seen.world(Landmark::kRightShoulder) -
                        seen.world(Landmark::kLeftHip) - seen.world(Landmark::kRightHip))
                           .norm();
  seen.is_usable = usable >= 4 && torso > 0.1;
  return seen;
}

bool place_on_rays(const Observation& seen,
                   const std::array<Vector3d, kLandmarkCount>& relative_C_m, Vector3d& place_C_m) {
  RayPlace place;
  place.add(seen, Matrix3d::Identity(), Vector3d::Zero(), 1.0, relative_C_m);
  return place.solve(place_C_m);
}

void RayPlace::add(const Observation& seen, const Matrix3d& R_VC, const Vector3d& p_VC_m,
                   double trust, const std::array<Vector3d, kLandmarkCount>& relative_C_m) {
  for (std::size_t i = 0; i < kLandmarkCount; ++i) {
    const double w = trust * seen.weight[i] * (i <= index_of(Landmark::kMouthRight) ? 0.2 : 1.0);
    if (w <= 0.0) continue;
    const Vector3d p = R_VC * relative_C_m[i] + p_VC_m;
    for (int axis = 0; axis < 2; ++axis) {
      const double slope = seen.ray[i][axis];
      const Vector3d row = (R_VC.row(axis) - slope * R_VC.row(2)).transpose();
      A_ += w * row * row.transpose();
      b_ += w * row * (slope * p.z() - p[axis]);
    }
  }
}

bool RayPlace::solve(Vector3d& place_C_m) const {
  const Vector3d place = A_.ldlt().solve(b_);
  if (!place.allFinite() || !(place.z() > 0.3) || !(place.z() < 60.0)) return false;
  place_C_m = place;
  return true;
}

}  // namespace dance
