// RectifiedPair: rectification of a stereo pair: a point lies in the same row of both pictures.
// No picture is made: points go between the raw pictures and X, the common frame, so that only the
// patches in use are computed.
//
// Units/frames: X is the left camera's place, x along the line between the cameras, z midway
//               between their views; its pictures have f_px() and the middle (cx_px(), cy_px()) in
//               both cameras, so that depth along X's z = f·baseline / disparity. L and R as
//               stereo_rig.h says.
// Ownership:    plain value, no heap.
// Threads:      none inside; const calls from anywhere.
// Failure:      none; the rig was checked.
// Source:       Fusiello, Trucco, Verri: A compact algorithm for rectification of stereo pairs,
//               2000.
#pragma once

#include <Eigen/Core>

#include "producers/camera/stereo/stereo_rig.h"

namespace dance {

enum class Side { kLeft, kRight };

class RectifiedPair {
 public:
  explicit RectifiedPair(const StereoRig& rig);

  double f_px() const { return f_px_; }
  double cx_px() const { return cx_px_; }
  double cy_px() const { return cy_px_; }
  double baseline_m() const { return baseline_m_; }
  const StereoRig& rig() const { return rig_; }
  const Pinhole& camera(Side side) const { return side == Side::kLeft ? rig_.left : rig_.right; }

  // The axis along which X measures depth, in L.
  Eigen::Vector3d depth_axis_in_left() const { return R_XL_.row(2).transpose(); }

  // Of a raw pixel.
  Eigen::Vector2d rectified(Side side, const Eigen::Vector2d& raw_px) const;
  // Of a rectified one.
  Eigen::Vector2d raw(Side side, const Eigen::Vector2d& rectified_px) const;
  // In the raw left camera's frame, of a point of the left picture and its disparity.
  Eigen::Vector3d p_L_m(const Eigen::Vector2d& rectified_px, double disparity_px) const;

 private:
  StereoRig rig_;
  Eigen::Matrix3d R_XL_;
  Eigen::Matrix3d R_XR_;
  double f_px_;
  double cx_px_;
  double cy_px_;
  double baseline_m_;
};

}  // namespace dance
