// Random rotations, poses and directions for property tests: the same for the same seed.
//
// Units/frames: as core/pose/pose.h.
// Threads:      none inside.
// Failure:      none.
#pragma once

#include <Eigen/Geometry>
#include <cmath>

#include "core/base/random.h"
#include "core/pose/pose.h"

namespace dance {

inline Eigen::Vector3f random_direction(Random& random) {
  for (;;) {
    const Eigen::Vector3f v(static_cast<float>(random.uniform(-1.0, 1.0)),
                            static_cast<float>(random.uniform(-1.0, 1.0)),
                            static_cast<float>(random.uniform(-1.0, 1.0)));
    if (v.norm() > 0.1f && v.norm() <= 1.0f) return v.normalized();
  }
}

inline Eigen::Quaternionf random_rotation(Random& random, float largest_rad = 3.14f) {
  const auto angle_rad = static_cast<float>(random.uniform(0.0, static_cast<double>(largest_rad)));
  return Eigen::Quaternionf(Eigen::AngleAxisf(angle_rad, random_direction(random)));
}

inline Pose random_pose(Random& random, float largest_rad = 3.14f) {
  Pose pose;
  for (auto& rotation : pose.R_PB) rotation = random_rotation(random, largest_rad);
  pose.p_WH_m = 3.0f * random_direction(random);
  pose.confidence = static_cast<float>(random.uniform());
  return pose;
}

// Equal as rotations: q and -q are the same.
inline bool is_same_rotation(const Eigen::Quaternionf& a, const Eigen::Quaternionf& b,
                             float within_rad = 1e-3f) {
  return a.angularDistance(b) <= within_rad;
}

}  // namespace dance
