#include "formats/bvh/euler_zxy.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace dance {

// R21 = sin x,  R01 = −sin z cos x,  R11 = cos z cos x,  R20 = −cos x sin y,  R22 = cos x cos y.
std::array<double, 3> euler_zxy_deg(const Eigen::Quaterniond& rotation) {
  constexpr double kDegPerRad = 180.0 / std::numbers::pi;
  const Eigen::Matrix3d R = rotation.normalized().toRotationMatrix();
  const double x = std::asin(std::clamp(R(2, 1), -1.0, 1.0));
  if (std::abs(R(2, 1)) < 1.0 - 1e-9)
    return {std::atan2(-R(0, 1), R(1, 1)) * kDegPerRad, x * kDegPerRad,
            std::atan2(-R(2, 0), R(2, 2)) * kDegPerRad};
  return {std::atan2(R(1, 0), R(0, 0)) * kDegPerRad, x * kDegPerRad, 0.0};
}

}  // namespace dance
