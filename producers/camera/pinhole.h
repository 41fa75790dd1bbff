// Pinhole: how a camera maps space to pixels.
//
// Units/frames: C, the camera's frame: x right, y down, z into the scene, metres; pixels of the
//               given picture size, centre of the top left pixel at (0, 0). u = fx·x/z + cx, v =
//               fy·y/z + cy, after the distortion of OpenCV's five coefficients.
// Ownership:    plain value.
// Threads:      none inside.
// Failure:      none; the reader of a file checks it.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>

namespace dance {

struct Pinhole {
  int width_px = 0;
  int height_px = 0;
  double fx_px = 0.0;
  double fy_px = 0.0;
  double cx_px = 0.0;
  double cy_px = 0.0;
  std::array<double, 5> distortion{};  // k1 k2 p1 p2 k3
  bool is_measured = false;            // false: assumed from a field of view

  Eigen::Vector2d project(const Eigen::Vector3d& p_C_m) const {
    return {fx_px * p_C_m.x() / p_C_m.z() + cx_px, fy_px * p_C_m.y() / p_C_m.z() + cy_px};
  }
  bool operator==(const Pinhole&) const = default;
};

// For a camera of which nothing is known: square pixels, no distortion.
inline Pinhole assumed_pinhole(int width_px, int height_px, double horizontal_fov_deg = 65.0) {
  const double f =
      0.5 * width_px / std::tan(0.5 * horizontal_fov_deg * 3.14159265358979323846 / 180.0);
  return {width_px, height_px, f, f, 0.5 * (width_px - 1), 0.5 * (height_px - 1), {}, false};
}

}  // namespace dance
