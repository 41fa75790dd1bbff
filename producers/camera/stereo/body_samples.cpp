#include "producers/camera/stereo/body_samples.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/assert.h"
#include "producers/camera/lens.h"

namespace dance {
namespace {

constexpr float kLeastVisible = 0.5f;

// Half of an adult's girths, metres: what clothes add and what bodies differ by is in StereoDepth's
// spread.
constexpr double kTorsoHalfDepth_m = 0.115;
constexpr double kTorsoHalfWidth_m = 0.165;

struct LimbPlace {
  Landmark from;
  Landmark to;
  double part;  // 0 at `from`
  double radius_m;
};
constexpr std::array<LimbPlace, 12> kLimbPlaces{{
    {Landmark::kLeftShoulder, Landmark::kLeftElbow, 0.5, 0.048},
    {Landmark::kRightShoulder, Landmark::kRightElbow, 0.5, 0.048},
    {Landmark::kLeftShoulder, Landmark::kLeftElbow, 1.0, 0.042},
    {Landmark::kRightShoulder, Landmark::kRightElbow, 1.0, 0.042},
    {Landmark::kLeftHip, Landmark::kLeftKnee, 0.5, 0.078},
    {Landmark::kRightHip, Landmark::kRightKnee, 0.5, 0.078},
    {Landmark::kLeftHip, Landmark::kLeftKnee, 1.0, 0.058},
    {Landmark::kRightHip, Landmark::kRightKnee, 1.0, 0.058},
    {Landmark::kLeftKnee, Landmark::kLeftAnkle, 0.45, 0.054},
    {Landmark::kRightKnee, Landmark::kRightAnkle, 0.45, 0.054},
    {Landmark::kLeftKnee, Landmark::kLeftAnkle, 1.0, 0.040},
    {Landmark::kRightKnee, Landmark::kRightAnkle, 1.0, 0.040},
}};

Eigen::Vector2d pixel(const BodyLandmarks& body, Landmark l) {
  return body.image(l).head<2>().cast<double>();
}
Eigen::Vector3d metres(const BodyLandmarks& body, Landmark l) {
  return body.world(l).cast<double>();
}

Eigen::Vector3d towards_camera(const Eigen::Vector2d& straight) {
  return -straight.homogeneous().normalized();
}

void add(const Pinhole& camera, const Eigen::Vector2d& raw_px, const Eigen::Vector3d& p_m,
         double weight, BodySamples& out) {
  if (!raw_px.allFinite() || !p_m.allFinite()) return;
  if (raw_px.x() < 0.0 || raw_px.y() < 0.0 || raw_px.x() > camera.width_px - 1.0 ||
      raw_px.y() > camera.height_px - 1.0)
    return;
  const bool has_room = out.try_push({raw_px, undistorted(camera, raw_px), p_m, 0.0, weight});
  DANCE_ASSERT(has_room);
}

// A limb is a cylinder: seen along its length there is more of it before the axis.
double limb_skin_m(const Eigen::Vector3d& axis, const Eigen::Vector3d& view, double radius_m) {
  const double length = axis.norm();
  if (length < 1e-6) return radius_m;
  const double across = (axis / length).cross(view).norm();
  return radius_m / std::max(0.6, across);
}

void take_limbs(const Pinhole& camera, const BodyLandmarks& body, BodySamples& out) {
  for (const LimbPlace& place : kLimbPlaces) {
    const float seen = std::min(body.visible(place.from), body.visible(place.to));
    if (!(seen >= kLeastVisible)) continue;
    const Eigen::Vector2d from_px = pixel(body, place.from);
    const Eigen::Vector3d from_m = metres(body, place.from);
    const Eigen::Vector3d axis = metres(body, place.to) - from_m;
    const std::size_t before = out.size();
    add(camera, from_px + place.part * (pixel(body, place.to) - from_px),
        from_m + place.part * axis, seen, out);
    if (out.size() > before)
      out[before].skin_m = limb_skin_m(axis, towards_camera(out[before].straight), place.radius_m);
  }
}

struct Torso {
  std::array<Eigen::Vector2d, 4> px;  // left and right shoulder, left and right hip
  std::array<Eigen::Vector3d, 4> m;
  Eigen::Vector3d left;   // unit, to the dancer's left
  Eigen::Vector3d front;  // unit, out of breast or back
};

// The torso is an elliptic cylinder about its middle: how far along `view` its skin is from a point
// `aside` of the middle. A point outside that the torso does not hide is a joint of its own.
double torso_skin_m(const Torso& torso, double aside_m, const Eigen::Vector3d& view) {
  constexpr double kJoint_m = 0.055;
  const double vx = view.dot(torso.left) / kTorsoHalfWidth_m;
  const double vz = view.dot(torso.front) / kTorsoHalfDepth_m;
  const double x = aside_m / kTorsoHalfWidth_m;
  const double a = vx * vx + vz * vz;
  const double b = x * vx;
  const double inside = b * b - a * (x * x - 1.0);
  if (inside < 0.0 || a < 1e-9) return kJoint_m;
  return std::max(kJoint_m, (-b + std::sqrt(inside)) / a);
}

void take_torso(const Pinhole& camera, const BodyLandmarks& body, BodySamples& out) {
  constexpr std::array<Landmark, 4> kCorners{Landmark::kLeftShoulder, Landmark::kRightShoulder,
                                             Landmark::kLeftHip, Landmark::kRightHip};
  float seen = 1.0f;
  Torso torso;
  for (std::size_t i = 0; i < 4; ++i) {
    seen = std::min(seen, body.visible(kCorners[i]));
    torso.px[i] = pixel(body, kCorners[i]);
    torso.m[i] = metres(body, kCorners[i]);
  }
  if (!(seen >= kLeastVisible)) return;
  const Eigen::Vector3d across = torso.m[0] - torso.m[1] + torso.m[2] - torso.m[3];
  const Eigen::Vector3d up = torso.m[0] + torso.m[1] - torso.m[2] - torso.m[3];
  if (across.norm() < 1e-3 || up.norm() < 1e-3) return;
  torso.left = across.normalized();
  torso.front = torso.left.cross(up).normalized();

  const auto between = [](const auto& corners, double right, double down) {
    return ((1.0 - down) * ((1.0 - right) * corners[0] + right * corners[1]) +
            down * ((1.0 - right) * corners[2] + right * corners[3]))
        .eval();
  };
  for (double down : {0.0, 0.25, 0.5, 0.75, 1.0})
    for (double right : {0.0, 0.5, 1.0}) {
      // Necks have no texture; on the sides of the belly the arms hang.
      const bool is_edge = down == 0.0 || down == 1.0;
      if (down == 0.0 && right == 0.5) continue;
      const double place = is_edge ? right : 0.25 + 0.5 * right;
      const Eigen::Vector3d p_m = between(torso.m, place, down);
      const std::size_t before = out.size();
      add(camera, between(torso.px, place, down), p_m, seen, out);
      if (out.size() == before) continue;
      const double aside_m = (p_m - between(torso.m, 0.5, down)).dot(torso.left);
      out[before].skin_m = torso_skin_m(torso, aside_m, towards_camera(out[before].straight));
    }
}

}  // namespace

void take_body_samples(const Pinhole& camera, const BodyLandmarks& body, BodySamples& out) {
  out.clear();
  take_torso(camera, body, out);
  take_limbs(camera, body, out);
}

}  // namespace dance
