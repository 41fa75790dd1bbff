#include "producers/camera/stereo/rectified_pair.h"

#include <Eigen/Geometry>

#include "producers/camera/lens.h"

namespace dance {

RectifiedPair::RectifiedPair(const StereoRig& rig) : rig_(rig), baseline_m_(rig.baseline_m()) {
  // The right camera, seen from the left one: p_LR = −Rᵀ·t.
  const Eigen::Vector3d across = (-rig.R_RL.transpose() * rig.p_RL_m).normalized();
  const Eigen::Vector3d views =
      Eigen::Vector3d::UnitZ() + rig.R_RL.transpose() * Eigen::Vector3d::UnitZ();
  const Eigen::Vector3d ahead = (views - views.dot(across) * across).normalized();
  R_XL_.row(0) = across;
  R_XL_.row(1) = ahead.cross(across);
  R_XL_.row(2) = ahead;
  R_XR_ = R_XL_ * rig.R_RL.transpose();
  f_px_ = 0.25 * (rig.left.fx_px + rig.left.fy_px + rig.right.fx_px + rig.right.fy_px);
  cx_px_ = 0.5 * (rig.left.cx_px + rig.right.cx_px);
  cy_px_ = 0.5 * (rig.left.cy_px + rig.right.cy_px);
}

Eigen::Vector2d RectifiedPair::rectified(Side side, const Eigen::Vector2d& raw_px) const {
  const Eigen::Vector2d straight = undistorted(camera(side), raw_px);
  const Eigen::Vector3d ray = (side == Side::kLeft ? R_XL_ : R_XR_) * straight.homogeneous();
  return {f_px_ * ray.x() / ray.z() + cx_px_, f_px_ * ray.y() / ray.z() + cy_px_};
}

Eigen::Vector2d RectifiedPair::raw(Side side, const Eigen::Vector2d& rectified_px) const {
  const Eigen::Vector3d ray((rectified_px.x() - cx_px_) / f_px_,
                            (rectified_px.y() - cy_px_) / f_px_, 1.0);
  const Eigen::Vector3d seen = (side == Side::kLeft ? R_XL_ : R_XR_).transpose() * ray;
  return pixel_of(camera(side), {seen.x() / seen.z(), seen.y() / seen.z()});
}

Eigen::Vector3d RectifiedPair::p_L_m(const Eigen::Vector2d& rectified_px,
                                     double disparity_px) const {
  const double depth_m = f_px_ * baseline_m_ / disparity_px;
  const Eigen::Vector3d p_X(depth_m * (rectified_px.x() - cx_px_) / f_px_,
                            depth_m * (rectified_px.y() - cy_px_) / f_px_, depth_m);
  return R_XL_.transpose() * p_X;
}

}  // namespace dance
