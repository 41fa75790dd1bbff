#include "core/pose/shortest_turn.h"

namespace dance {

Eigen::Quaterniond shortest_turn(const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  using Eigen::Vector3d;
  const double length = from.norm() * to.norm();
  if (!(length > 0.0)) return Eigen::Quaterniond::Identity();
  // Half the angle: (1 + cos, sin · axis) made unit. Within a millionth of opposite the axis is
  // noise.
  constexpr double kOpposite = 1e-12;
  const double w = 1.0 + from.dot(to) / length;
  if (w < kOpposite) {
    const Vector3d aside = from.cross(Vector3d::UnitX());
    const Vector3d axis =
        aside.norm() > 0.1 * from.norm() ? aside : Vector3d(from.cross(Vector3d::UnitY()));
    const Vector3d unit = axis.normalized();
    return {0.0, unit.x(), unit.y(), unit.z()};
  }
  const Vector3d v = from.cross(to) / length;
  return Eigen::Quaterniond(w, v.x(), v.y(), v.z()).normalized();
}

}  // namespace dance
