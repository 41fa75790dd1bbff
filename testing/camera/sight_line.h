// The way of light from a camera to a point, and what it passes: whether a limb is before a point.
//
// Units/frames: metres; the camera is the origin.
// Ownership:    plain values.
// Threads:      none inside.
// Failure:      none.
// Source:       the least distance of two segments: Ericson, Real-Time Collision Detection, 2005,
//               5.1.9.
#pragma once

#include <Eigen/Core>
#include <algorithm>

namespace dance {

struct NearestPass {
  double distance_m = 0.0;
  double share = 0.0;  // of the way to the point, where it passes nearest
};

// Of the way from the origin to p, and the segment from a to b.
inline NearestPass nearest_pass(const Eigen::Vector3d& p, const Eigen::Vector3d& a,
                                const Eigen::Vector3d& b) {
  const Eigen::Vector3d v = b - a, w = -a;
  const double pp = p.dot(p), pv = p.dot(v), vv = std::max(v.dot(v), 1e-9), pw = p.dot(w),
               vw = v.dot(w);
  const double under = std::max(pp * vv - pv * pv, 1e-9);
  double share = std::clamp((pv * vw - vv * pw) / under, 0.0, 1.0);
  const double t = std::clamp((pv * share + vw) / vv, 0.0, 1.0);
  share = std::clamp((pv * t - pw) / std::max(pp, 1e-9), 0.0, 1.0);
  return {(share * p - a - t * v).norm(), share};
}

}  // namespace dance
