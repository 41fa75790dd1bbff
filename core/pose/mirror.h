// Seen in the mirror x = 0: turns about x stay, those about y and z change their sign. Sides are
// the caller's to exchange.
//
// Units/frames: any frame whose x points to one side, as core/pose/pose.h has them.
// Ownership:    plain values.
// Threads:      none inside.
// Failure:      none.
#pragma once

#include <Eigen/Geometry>

namespace dance {

inline Eigen::Vector3f mirrored(const Eigen::Vector3f& p) { return {-p.x(), p.y(), p.z()}; }
inline Eigen::Quaternionf mirrored(const Eigen::Quaternionf& q) {
  return {q.w(), q.x(), -q.y(), -q.z()};
}

}  // namespace dance
