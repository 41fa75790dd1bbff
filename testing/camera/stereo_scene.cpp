#include "testing/camera/stereo_scene.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "core/base/random.h"
#include "producers/camera/lens.h"

namespace dance {
namespace {

std::uint32_t hash_of(std::int32_t x, std::int32_t y, std::int32_t z, std::uint32_t pattern) {
  std::uint32_t h = pattern * 0x9e3779b9u + 0x85ebca6bu;
  for (const std::int32_t v : {x, y, z}) {
    h ^= static_cast<std::uint32_t>(v) * 0xcc9e2d51u;
    h = (h << 15) | (h >> 17);
    h = h * 5u + 0xe6546b64u;
  }
  h ^= h >> 16;
  h *= 0x7feb352du;
  return h ^ (h >> 15);
}

double lattice(std::int32_t x, std::int32_t y, std::int32_t z, std::uint32_t pattern) {
  return hash_of(x, y, z, pattern) * (2.0 / 4294967295.0) - 1.0;
}

double smooth_noise(const Eigen::Vector3d& p, std::uint32_t pattern) {
  std::int32_t i[3];
  double f[3];
  for (int k = 0; k < 3; ++k) {
    const double floor = std::floor(p(k));
    i[k] = static_cast<std::int32_t>(floor);
    const double t = p(k) - floor;
    f[k] = t * t * (3.0 - 2.0 * t);
  }
  double sum = 0.0;
  for (int corner = 0; corner < 8; ++corner) {
    const int dx = corner & 1;
    const int dy = (corner >> 1) & 1;
    const int dz = corner >> 2;
    const double weight =
        (dx ? f[0] : 1.0 - f[0]) * (dy ? f[1] : 1.0 - f[1]) * (dz ? f[2] : 1.0 - f[2]);
    sum += weight * lattice(i[0] + dx, i[1] + dy, i[2] + dz, pattern);
  }
  return sum;
}

}  // namespace

double pattern_at(const Eigen::Vector3d& p_m, double grain_m, std::uint32_t pattern) {
  double sum = 0.0;
  double size = 2.0;
  for (std::uint32_t octave = 0; octave < 3; ++octave) {
    sum += size * smooth_noise(p_m / (grain_m * size), pattern * 3u + octave);
    size *= 0.5;
  }
  // Deviation of the sum of three octaves of amplitudes 2, 1, 1/2.
  return sum / 0.75;
}

StereoScene::StereoScene(const StereoRig& rig, const SceneEyes& eyes, std::uint64_t seed)
    : rig_(rig), eyes_(eyes), seed_(seed) {
  for (int side = 0; side < 2; ++side) {
    const Pinhole& eye = side == 0 ? rig.left : rig.right;
    rays_[side].reserve(static_cast<std::size_t>(eye.width_px) *
                        static_cast<std::size_t>(eye.height_px));
    for (int v = 0; v < eye.height_px; ++v)
      for (int u = 0; u < eye.width_px; ++u) {
        const Eigen::Vector2d straight = undistorted(eye, {u, v});
        rays_[side].push_back({static_cast<float>(straight.x()), static_cast<float>(straight.y())});
      }
  }
  for (const Side side : {Side::kLeft, Side::kRight}) draw_wall(side);
}

void StereoScene::draw(std::span<const SceneLimb> limbs, std::span<const SceneLimb> limbs_of_right,
                       cv::Mat& left, cv::Mat& right) {
  ++frame_;
  draw_eye(Side::kLeft, limbs, left);
  draw_eye(Side::kRight, limbs_of_right, right);
}

void StereoScene::draw_eye(Side side, std::span<const SceneLimb> limbs, cv::Mat& out) {
  const int i = side == Side::kLeft ? 0 : 1;
  wall_depth_[i].copyTo(depth_);
  wall_colour_[i].copyTo(colour_);
  for (const SceneLimb& limb : limbs) draw_limb(side, limb);
  finish(side, out);
}

namespace {

// p_S = origin + t·direction, of a pixel's ray.
struct SceneView {
  Eigen::Matrix3d R_SC;
  Eigen::Vector3d p_SC_m;
};

SceneView view_of(const StereoRig& rig, Side side) {
  if (side == Side::kLeft) return {Eigen::Matrix3d::Identity(), Eigen::Vector3d::Zero()};
  return {rig.R_RL.transpose(), -rig.R_RL.transpose() * rig.p_RL_m};
}

}  // namespace

void StereoScene::draw_wall(Side side) {
  const SceneView view = view_of(rig_, side);
  const int i = side == Side::kLeft ? 0 : 1;
  cv::Mat_<float>& depth = wall_depth_[i];
  cv::Mat_<float>& colour = wall_colour_[i];
  depth.create(rig_.left.height_px, rig_.left.width_px);
  colour.create(rig_.left.height_px, rig_.left.width_px);
  const Ray* ray = rays_[i].data();
  for (int v = 0; v < depth.rows; ++v)
    for (int u = 0; u < depth.cols; ++u, ++ray) {
      const Eigen::Vector3d direction = view.R_SC * Eigen::Vector3d(ray->x, ray->y, 1.0);
      const double t = (eyes_.wall_m - view.p_SC_m.z()) / direction.z();
      const Eigen::Vector3d p = view.p_SC_m + t * direction;
      depth(v, u) = static_cast<float>(1.0 / t);
      colour(v, u) = static_cast<float>(130.0 + eyes_.wall_contrast * pattern_at(p, 0.03, 77));
    }
}

cv::Rect StereoScene::box_of(Side side, const SceneLimb& limb) const {
  const SceneView view = view_of(rig_, side);
  const Pinhole& eye = side == Side::kLeft ? rig_.left : rig_.right;
  Eigen::AlignedBox2d box;
  for (const Eigen::Vector3d& end : {limb.from_m, limb.to_m}) {
    const Eigen::Vector3d p = view.R_SC.transpose() * (end - view.p_SC_m);
    const double reach = limb.half_m * std::max(1.0, limb.flatness);
    const double z = std::max(0.2, p.z() - reach);
    for (int corner = 0; corner < 8; ++corner) {
      const Eigen::Vector2d straight(
          (p.x() + (corner & 1 ? reach : -reach)) / (corner & 4 ? z : p.z()),
          (p.y() + (corner & 2 ? reach : -reach)) / (corner & 4 ? z : p.z()));
      box.extend(pixel_of(eye, straight));
    }
  }
  const cv::Rect picture(0, 0, eye.width_px, eye.height_px);
  const cv::Point from(static_cast<int>(std::clamp(box.min().x(), -1e4, 1e4)) - 3,
                       static_cast<int>(std::clamp(box.min().y(), -1e4, 1e4)) - 3);
  const cv::Point to(static_cast<int>(std::clamp(box.max().x(), -1e4, 1e4)) + 4,
                     static_cast<int>(std::clamp(box.max().y(), -1e4, 1e4)) + 4);
  return cv::Rect(from, to) & picture;
}

// The limb's own frame has its axis along y; dividing x and z by the half axes makes a round
// cylinder of radius 1, whose ends are closed by half ellipsoids.
void StereoScene::draw_limb(Side side, const SceneLimb& limb) {
  const SceneView view = view_of(rig_, side);
  const Eigen::Vector3d axis = (limb.to_m - limb.from_m).normalized();
  Eigen::Vector3d x = limb.aside - limb.aside.dot(axis) * axis;
  if (x.norm() < 1e-6) x = axis.unitOrthogonal();
  x.normalize();
  Eigen::Matrix3d R_LS;
  R_LS.row(0) = x;
  R_LS.row(1) = axis;
  R_LS.row(2) = x.cross(axis);
  const double cap = limb.half_m * std::min(1.0, limb.flatness);
  const Eigen::Vector3d size(limb.half_m, cap, limb.half_m * limb.flatness);
  const double length = (limb.to_m - limb.from_m).norm() / cap;
  const Eigen::Vector3d origin = (R_LS * (view.p_SC_m - limb.from_m)).cwiseQuotient(size);
  const Eigen::Matrix3d turn = size.cwiseInverse().asDiagonal() * R_LS * view.R_SC;
  const cv::Rect box = box_of(side, limb);
  for (int v = box.y; v < box.br().y; ++v) {
    const Ray* ray = rays_[side == Side::kLeft ? 0 : 1].data() +
                     static_cast<std::size_t>(v) * static_cast<std::size_t>(depth_.cols);
    for (int u = box.x; u < box.br().x; ++u) {
      const Eigen::Vector3d d = turn * Eigen::Vector3d(ray[u].x, ray[u].y, 1.0);
      // Round cylinder: (o + t·d)_xz has length 1.
      double a = d.x() * d.x() + d.z() * d.z();
      double b = origin.x() * d.x() + origin.z() * d.z();
      double c = origin.x() * origin.x() + origin.z() * origin.z() - 1.0;
      double h = b * b - a * c;
      double t = h > 0.0 ? (-b - std::sqrt(h)) / a : -1.0;
      double y = origin.y() + t * d.y();
      if (h <= 0.0 || y < 0.0 || y > length) {
        // An end's ball.
        const double end = h > 0.0 && y > length ? length : h > 0.0 ? 0.0 : -1.0;
        if (end < 0.0) continue;
        const double oy = origin.y() - end;
        a += d.y() * d.y();
        b += oy * d.y();
        c += oy * oy;
        h = b * b - a * c;
        if (h <= 0.0) continue;
        t = (-b - std::sqrt(h)) / a;
      }
      if (t <= 0.0 || 1.0 / t <= depth_(v, u)) continue;
      const Eigen::Vector3d local = (origin + t * d).cwiseProduct(size);
      depth_(v, u) = static_cast<float>(1.0 / t);
      // Light from above and the left camera's side.
      const Eigen::Vector3d normal =
          Eigen::Vector3d(local.x() / (size.x() * size.x()), 0.0, local.z() / (size.z() * size.z()))
              .normalized();
      const double light = 0.8 + 0.2 * normal.dot(R_LS * Eigen::Vector3d(-0.4, -0.6, -0.7));
      colour_(v, u) = static_cast<float>(
          light * (limb.brightness + limb.contrast * pattern_at(local, 0.015, limb.pattern)));
    }
  }
}

void StereoScene::finish(Side side, cv::Mat& out) {
  if (eyes_.blur_px > 0.0) cv::GaussianBlur(colour_, colour_, cv::Size(), eyes_.blur_px);
  out.create(depth_.rows, depth_.cols, CV_8UC3);
  const bool is_right = side == Side::kRight;
  const float gain = is_right ? static_cast<float>(eyes_.right_gain) : 1.0f;
  const float offset = is_right ? static_cast<float>(eyes_.right_offset) : 0.0f;
  Random random(seed_ + 1000003 * frame_ + (is_right ? 1 : 0));
  // Three channels, noise of their own: the sum of four uniform numbers of 16 bits is near enough
  // to normal.
  const auto noise = [&] {
    const std::uint64_t bits = random.next_u64();
    double sum = 0.0;
    for (int i = 0; i < 4; ++i) sum += static_cast<double>((bits >> (16 * i)) & 0xffffu);
    return static_cast<float>((sum / 65535.0 - 2.0) * 1.7320508 * eyes_.noise);
  };
  for (int v = 0; v < out.rows; ++v) {
    auto* row = out.ptr<cv::Vec3b>(v);
    for (int u = 0; u < out.cols; ++u) {
      const float level = gain * colour_(v, u) + offset;
      for (int k = 0; k < 3; ++k) row[u][k] = cv::saturate_cast<std::uint8_t>(level + noise());
    }
  }
}

}  // namespace dance
