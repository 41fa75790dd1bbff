// Rotation vectors (axis times angle), the exponential map and its logarithm: for offsets, speeds
// and limits of joints.
//
// Units/frames: radians, at most half a turn.
// Ownership:    plain values.
// Threads:      none.
// Failure:      none; of a rotation that is not unit only the direction counts.
#pragma once

#include <Eigen/Geometry>
#include <cmath>

namespace dance {

// log: q and -q are the same rotation and give the same vector.
inline Eigen::Vector3f rotation_vector(const Eigen::Quaternionf& q) {
  const float sine = q.vec().norm();
  // angle / sin(angle / 2); 2 / w where the angle is small.
  if (sine < 1e-6f) return q.vec() * (q.w() < 0.0f ? -2.0f : 2.0f);
  const float angle = 2.0f * std::atan2(sine, std::abs(q.w()));
  return q.vec() * ((q.w() < 0.0f ? -angle : angle) / sine);
}

inline Eigen::Quaternionf exp_rotation(const Eigen::Vector3f& v) {
  const float half = 0.5f * v.norm();
  // sin(half) / (2 half)
  const float scale = half < 1e-4f ? 0.5f : 0.5f * std::sin(half) / half;
  Eigen::Quaternionf q;
  q.w() = half < 1e-4f ? 1.0f : std::cos(half);
  q.vec() = scale * v;
  return q;
}

}  // namespace dance
