#include "formats/osc/tracker_angles.h"

#include <algorithm>
#include <cmath>

namespace dance {
namespace {

constexpr float kDegree = 3.14159265358979f / 180.0f;
constexpr float kMostAngle_deg = 7200.0f;
// Cosine of x below which y and z cannot be told apart.
constexpr float kUpright = 1e-3f;

float nearest_turn_deg(float angle_deg, float last_deg) {
  return angle_deg + 360.0f * std::round((last_deg - angle_deg) / 360.0f);
}

Eigen::Vector3f nearest_turns_deg(const Eigen::Vector3f& angles_deg, const Eigen::Vector3f& last) {
  return {nearest_turn_deg(angles_deg.x(), last.x()), nearest_turn_deg(angles_deg.y(), last.y()),
          nearest_turn_deg(angles_deg.z(), last.z())};
}

}  // namespace

Eigen::Vector3f TrackerAngles::follow(const Eigen::Quaternionf& R) {
  // m = Ry Rx Rz: m12 = −sin x, m02 = cos x sin y, m22 = cos x cos y, m10 = cos x sin z,
  // m11 = cos x cos z.
  const Eigen::Matrix3f m = R.toRotationMatrix();
  const float cos_x = std::hypot(m(0, 2), m(2, 2));
  Eigen::Vector3f angles_deg;
  angles_deg.x() = std::atan2(-m(1, 2), cos_x) / kDegree;
  if (cos_x > kUpright) {
    angles_deg.y() = std::atan2(m(0, 2), m(2, 2)) / kDegree;
    angles_deg.z() = std::atan2(m(1, 0), m(1, 1)) / kDegree;
  } else {
    // x = ±90°: m00 = cos(y ∓ z), m20 = −sin(y ∓ z).
    const float both_deg = std::atan2(-m(2, 0), m(0, 0)) / kDegree;
    angles_deg.z() = last_deg_.z();
    angles_deg.y() = both_deg + std::copysign(1.0f, angles_deg.x()) * angles_deg.z();
  }
  // The same rotation has a second set of angles.
  const Eigen::Vector3f other_deg(180.0f - angles_deg.x(), angles_deg.y() + 180.0f,
                                  angles_deg.z() + 180.0f);
  const Eigen::Vector3f a = nearest_turns_deg(angles_deg, last_deg_);
  const Eigen::Vector3f b = nearest_turns_deg(other_deg, last_deg_);
  last_deg_ = (a - last_deg_).squaredNorm() <= (b - last_deg_).squaredNorm() ? a : b;
  for (int i = 0; i < 3; ++i)
    if (std::abs(last_deg_[i]) > kMostAngle_deg)
      last_deg_[i] -= std::copysign(kMostAngle_deg, last_deg_[i]);
  return last_deg_;
}

Eigen::Quaternionf rotation_of_angles(const Eigen::Vector3f& angles_deg) {
  return Eigen::Quaternionf(Eigen::AngleAxisf(angles_deg.y() * kDegree, Eigen::Vector3f::UnitY()) *
                            Eigen::AngleAxisf(angles_deg.x() * kDegree, Eigen::Vector3f::UnitX()) *
                            Eigen::AngleAxisf(angles_deg.z() * kDegree, Eigen::Vector3f::UnitZ()));
}

}  // namespace dance
