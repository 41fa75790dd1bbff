// OtherView: what a second, third or fourth camera saw of the dancer, and where that camera stands
// beside the first.
//
// Units/frames: C is the first camera's frame, V the other's (both as producers/camera/pinhole.h);
//               metres, seconds.
// Ownership:    plain value, no heap.
// Threads:      none inside.
// Failure:      a view with trust 0, or whose observation is not usable, is left out.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>

#include "producers/camera/solver/observation.h"

namespace dance {

constexpr std::size_t kMostOtherViews = 3;

struct OtherView {
  Observation seen;
  Eigen::Matrix3d R_VC = Eigen::Matrix3d::Identity();
  Eigen::Vector3d p_VC_m = Eigen::Vector3d::Zero();
  // How long before the first camera's picture this one was taken; negative: after it.
  double older_s = 0.0;
  // Of a ray, beside its own: the cameras' placement, and where two networks differ.
  double placement_sd = 0.0;
  double trust = 1.0;  // 0…1
};
using OtherViews = std::span<const OtherView>;

}  // namespace dance
