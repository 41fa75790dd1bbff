// Lens: what glass does to the pinhole: OpenCV's five coefficients, both ways, for single points.
//
// Units/frames: normalised points are x/z, y/z in C of producers/camera/pinhole.h; pixels as there.
// Ownership:    plain values, no heap.
// Threads:      none inside.
// Failure:      undistorted() of a pixel that the lens model never reaches gives the nearest that
//               its steps come to.
// Source:       Brown: Close-range camera calibration, 1971, in the letters of OpenCV's
//               documentation.
#pragma once

#include <Eigen/Core>

#include "producers/camera/pinhole.h"

namespace dance {

// x' = x·(1 + k1·r² + k2·r⁴ + k3·r⁶) + 2·p1·x·y + p2·(r² + 2x²), and y' likewise.
inline Eigen::Vector2d distorted(const Pinhole& camera, const Eigen::Vector2d& straight) {
  const auto& [k1, k2, p1, p2, k3] = camera.distortion;
  const double x = straight.x();
  const double y = straight.y();
  const double r2 = x * x + y * y;
  const double radial = 1.0 + r2 * (k1 + r2 * (k2 + r2 * k3));
  return {x * radial + 2.0 * p1 * x * y + p2 * (r2 + 2.0 * x * x),
          y * radial + p1 * (r2 + 2.0 * y * y) + 2.0 * p2 * x * y};
}

inline Eigen::Vector2d pixel_of(const Pinhole& camera, const Eigen::Vector2d& straight) {
  const Eigen::Vector2d bent = distorted(camera, straight);
  return {camera.fx_px * bent.x() + camera.cx_px, camera.fy_px * bent.y() + camera.cy_px};
}

// The normalised point that the lens shows at a pixel: fixed-point steps, which settle within the
// picture of any lens that five coefficients describe.
inline Eigen::Vector2d undistorted(const Pinhole& camera, const Eigen::Vector2d& pixel_px) {
  const Eigen::Vector2d bent((pixel_px.x() - camera.cx_px) / camera.fx_px,
                             (pixel_px.y() - camera.cy_px) / camera.fy_px);
  Eigen::Vector2d straight = bent;
  for (int step = 0; step < 20; ++step) {
    const Eigen::Vector2d miss = bent - distorted(camera, straight);
    straight += miss;
    if (miss.squaredNorm() < 1e-18) break;
  }
  return straight;
}

}  // namespace dance
