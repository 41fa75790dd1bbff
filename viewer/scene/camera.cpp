#include "viewer/scene/camera.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/assert.h"

namespace dance {

using Eigen::Matrix3f;
using Eigen::Matrix4f;
using Eigen::Vector2f;
using Eigen::Vector3f;

namespace {

constexpr float kNear_m = 0.1f;
constexpr float kEyeNear_m = 0.04f;  // own hands come close to the eyes
constexpr float kFar_m = 400.0f;
constexpr float kClosest_m = 1.2f;
constexpr float kThreeQuarter_rad = 0.35f;

Matrix4f view_matrix(const Matrix3f& axes_W, const Vector3f& eye_W_m) {
  Matrix4f view = Matrix4f::Identity();
  view.topLeftCorner<3, 3>() = axes_W.transpose();
  view.topRightCorner<3, 1>() = -(axes_W.transpose() * eye_W_m);
  return view;
}

}  // namespace

Matrix3f OrbitCamera::axes_W() const {
  const float cp = std::cos(pitch_rad);
  const Vector3f backward(std::sin(yaw_rad) * cp, std::sin(pitch_rad), std::cos(yaw_rad) * cp);
  const Vector3f right(std::cos(yaw_rad), 0.0f, -std::sin(yaw_rad));
  Matrix3f axes;
  axes.col(0) = right;
  axes.col(1) = backward.cross(right);
  axes.col(2) = backward;
  return axes;
}

Vector3f OrbitCamera::eye_W_m() const { return target_W_m + distance_m * axes_W().col(2); }

Matrix4f OrbitCamera::view_from_world() const { return view_matrix(axes_W(), eye_W_m()); }

Matrix4f OrbitCamera::clip_from_view(float aspect) const {
  const float f = 1.0f / std::tan(0.5f * fov_y_rad);
  Matrix4f clip = Matrix4f::Zero();
  clip(0, 0) = f / aspect;
  clip(1, 1) = f;
  clip(2, 2) = (kFar_m + kNear_m) / (kNear_m - kFar_m);
  clip(2, 3) = 2.0f * kFar_m * kNear_m / (kNear_m - kFar_m);
  clip(3, 2) = -1.0f;
  return clip;
}

StageEye eye_of(const OrbitCamera& camera, int width_px, int height_px) {
  const auto height = static_cast<float>(height_px);
  return {camera.eye_W_m(), camera.view_from_world(),
          camera.clip_from_world(static_cast<float>(width_px) / height),
          height / (2.0f * std::tan(0.5f * camera.fov_y_rad))};
}

StageEye eye_at(const Vector3f& eye_W_m, const Matrix3f& R_WE, const EyeTangents& tangents,
                int height_px) {
  const float width = tangents.right - tangents.left;
  const float height = tangents.up - tangents.down;
  Matrix4f clip = Matrix4f::Zero();
  clip(0, 0) = 2.0f / width;
  clip(0, 2) = (tangents.right + tangents.left) / width;
  clip(1, 1) = 2.0f / height;
  clip(1, 2) = (tangents.up + tangents.down) / height;
  clip(2, 2) = (kFar_m + kEyeNear_m) / (kEyeNear_m - kFar_m);
  clip(2, 3) = 2.0f * kFar_m * kEyeNear_m / (kEyeNear_m - kFar_m);
  clip(3, 2) = -1.0f;
  const Matrix4f view = view_matrix(R_WE, eye_W_m);
  return {eye_W_m, view, clip * view, static_cast<float>(height_px) / height};
}

std::optional<ScreenPoint> project(const OrbitCamera& camera, const Vector3f& p_W_m, float width_px,
                                   float height_px) {
  const Eigen::Vector4f clip =
      camera.clip_from_world(width_px / height_px) * p_W_m.homogeneous().eval();
  if (clip.w() < kNear_m) return std::nullopt;
  const float side = camera.is_mirrored ? -0.5f : 0.5f;
  return ScreenPoint{(0.5f + side * clip.x() / clip.w()) * width_px,
                     (0.5f - 0.5f * clip.y() / clip.w()) * height_px, clip.w()};
}

// In the camera's axes a point p is inside the right plane when p.x − c.x ≤ t·(c.z − p.z), with c
// the camera and t the slope of the plane; likewise for the other three. Each pair of planes gives
// the c.x (c.y) that puts both at their tightest, and a least c.z; the larger of the two c.z holds
// all four.
OrbitCamera frame_points(const OrbitCamera& camera, std::span<const Vector3f> points_W_m,
                         float aspect, float fill, float covered_below) {
  DANCE_ASSERT(fill > 0.0f && fill <= 1.0f && aspect > 0.0f, fill, aspect);
  DANCE_ASSERT(covered_below >= 0.0f && covered_below <= 0.4f, covered_below);
  if (points_W_m.empty()) return camera;
  const Matrix3f axes = camera.axes_W();
  // Margins are shares of what is not covered.
  const float slope_y = std::tan(0.5f * camera.fov_y_rad);
  const float margin = (1.0f - fill) * (1.0f - covered_below);
  const float above_y = slope_y * (1.0f - margin);
  const float below_y = slope_y * (1.0f - margin - 2.0f * covered_below);
  const Vector2f above(slope_y * fill * aspect, above_y);
  const Vector2f below(slope_y * fill * aspect, std::max(below_y, 0.05f * slope_y));

  Vector2f high = Vector2f::Constant(std::numeric_limits<float>::lowest());
  Vector2f low = high;
  float nearest = std::numeric_limits<float>::lowest();
  float depth_sum = 0.0f;
  for (const Vector3f& p_W : points_W_m) {
    const Vector3f p = axes.transpose() * p_W;
    for (int axis = 0; axis < 2; ++axis) {
      high[axis] = std::max(high[axis], p[axis] / above[axis] + p.z());
      low[axis] = std::max(low[axis], -p[axis] / below[axis] + p.z());
    }
    nearest = std::max(nearest, p.z());
    depth_sum += p.z();
  }
  Vector3f eye;
  eye.z() = nearest + kClosest_m;
  for (int axis = 0; axis < 2; ++axis) {
    const float tightest =
        (above[axis] * high[axis] + below[axis] * low[axis]) / (above[axis] + below[axis]);
    eye.z() = std::max(eye.z(), tightest);
  }
  // The middle of what is left at that distance.
  for (int axis = 0; axis < 2; ++axis)
    eye[axis] = 0.5f * (above[axis] * (high[axis] - eye.z()) + below[axis] * (eye.z() - low[axis]));

  OrbitCamera framed = camera;
  const float middle = depth_sum / static_cast<float>(points_W_m.size());
  framed.distance_m = std::max(eye.z() - middle, kClosest_m);
  framed.target_W_m = axes * Vector3f(eye.x(), eye.y(), eye.z() - framed.distance_m);
  return framed;
}

float best_yaw_rad(std::span<const Vector3f> hips_W_m, std::span<const Vector3f> facing_W) {
  DANCE_ASSERT(hips_W_m.size() == facing_W.size(), hips_W_m.size(), facing_W.size());
  if (hips_W_m.empty()) return OrbitCamera().yaw_rad;
  Vector3f facing = Vector3f::Zero();
  Vector3f middle = Vector3f::Zero();
  for (std::size_t i = 0; i < hips_W_m.size(); ++i) {
    facing += facing_W[i];
    middle += hips_W_m[i] / static_cast<float>(hips_W_m.size());
  }
  const auto yaw_of = [](const Vector3f& to_eye) { return std::atan2(to_eye.x(), to_eye.z()); };
  if (hips_W_m.size() == 1) return yaw_of(facing) + kThreeQuarter_rad;

  // The long axis of the group on the floor, from its second moments.
  float xx = 0.0f, xz = 0.0f, zz = 0.0f;
  for (const Vector3f& p : hips_W_m) {
    const Vector3f d = p - middle;
    xx += d.x() * d.x();
    xz += d.x() * d.z();
    zz += d.z() * d.z();
  }
  const float along = 0.5f * std::atan2(2.0f * xz, xx - zz);
  Vector3f across(-std::sin(along), 0.0f, std::cos(along));
  // Partners face each other: their facings cancel, and then either side is as good; +Z is the
  // front of the stage.
  const float side = std::abs(facing.dot(across)) > 0.3f ? facing.dot(across) : across.z() + 1e-3f;
  if (side < 0.0f) across = -across;
  return yaw_of(across);
}

Matrix4f light_clip_from_world(const Vector3f& to_light_W, const Vector3f& centre_W_m,
                               float radius_m, int map_size_px) {
  Matrix3f axes;
  axes.col(2) = to_light_W.normalized();
  Vector3f right = Vector3f::UnitY().cross(axes.col(2));
  if (right.squaredNorm() < 1e-6f) right = Vector3f::UnitX();
  axes.col(0) = right.normalized();
  axes.col(1) = axes.col(2).cross(axes.col(0));

  const float texel_m = 2.0f * radius_m / static_cast<float>(map_size_px);
  Vector3f centre = axes.transpose() * centre_W_m;
  for (int axis = 0; axis < 2; ++axis) centre[axis] = std::round(centre[axis] / texel_m) * texel_m;

  Matrix4f clip = Matrix4f::Identity();
  clip(0, 0) = clip(1, 1) = 1.0f / radius_m;
  clip(2, 2) = -1.0f / radius_m;
  return clip * view_matrix(axes, axes * centre);
}

}  // namespace dance
