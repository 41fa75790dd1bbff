// Rotations to try codecs with: evenly spread over all there are, and the angle between two.
//
// Units/frames: degrees; any frame.
// Ownership:    plain values.
// Threads:      none.
// Failure:      none.
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "core/base/random.h"

namespace dance {

inline Eigen::Quaternionf any_rotation(Random& random) {
  Eigen::Vector4d v(random.normal(), random.normal(), random.normal(), random.normal());
  Eigen::Quaternionf q;
  q.coeffs() = v.normalized().cast<float>();
  return q;
}

// With doubles: acos of a float near 1 cannot tell 0.02° from 0.
inline double angle_deg(const Eigen::Quaternionf& a, const Eigen::Quaternionf& b) {
  const Eigen::Vector4d u = a.coeffs().cast<double>().normalized();
  const Eigen::Vector4d v = b.coeffs().cast<double>().normalized();
  const double chord = std::min((u - v).norm(), (u + v).norm());
  return 4.0 * std::asin(std::min(1.0, chord / 2.0)) * 180.0 / M_PI;
}

}  // namespace dance
