// Heading: the part of a rotation that turns about the vertical, as an angle and as a rotation.
//
// Units/frames: radians about +Y, 0 along +Z, positive to the left; −π … π.
// Ownership:    plain values.
// Threads:      none inside.
// Failure:      none; upside down the heading is arbitrary.
#pragma once

#include <Eigen/Geometry>
#include <cmath>

namespace dance {

inline float heading_rad(const Eigen::Quaternionf& R) {
  return 2.0f * std::atan2(R.w() < 0.0f ? -R.y() : R.y(), std::abs(R.w()));
}

inline Eigen::Quaternionf about_up(float heading_rad) {
  return {std::cos(0.5f * heading_rad), 0.0f, std::sin(0.5f * heading_rad), 0.0f};
}

// R_heading of R = R_heading · R_tilt; identity where it is undefined.
inline Eigen::Quaternionf heading_turn(const Eigen::Quaternionf& R) {
  const float size = std::hypot(R.w(), R.y());
  return size > 1e-6f ? Eigen::Quaternionf(R.w() / size, 0.0f, R.y() / size, 0.0f)
                      : Eigen::Quaternionf::Identity();
}

}  // namespace dance
