// StereoRig: two cameras that look the same way, and how they stand to each other; Calibration: of
// one camera or of two, as a file has it.
//
// Units/frames: L and R are the frames of the left and the right camera, each as C of
//               producers/camera/pinhole.h (raw, not rectified); p_R = R_RL · p_L + p_RL_m, as
//               OpenCV has it: for cameras side by side p_RL_m is about (-baseline, 0, 0).
// Ownership:    plain values.
// Threads:      none inside.
// Failure:      none; values read from a file have to pass checked().
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>

#include "core/base/result.h"
#include "producers/camera/pinhole.h"

namespace dance {

struct StereoRig {
  Pinhole left;
  Pinhole right;
  Eigen::Matrix3d R_RL = Eigen::Matrix3d::Identity();
  Eigen::Vector3d p_RL_m = Eigen::Vector3d::Zero();

  double baseline_m() const { return p_RL_m.norm(); }
};

struct Calibration {
  Pinhole camera;                 // the only one, or the left
  std::optional<StereoRig> pair;  // its `left` is `camera`
};

// The same camera at a picture of another size: whole pictures that were made smaller or larger, of
// the same shape. Pixel centres are whole numbers, so that the middle of the picture stays the
// middle.
inline Pinhole resized(const Pinhole& camera, int width_px, int height_px) {
  const double sx = static_cast<double>(width_px) / camera.width_px;
  const double sy = static_cast<double>(height_px) / camera.height_px;
  Pinhole out = camera;
  out.width_px = width_px;
  out.height_px = height_px;
  out.fx_px *= sx;
  out.fy_px *= sy;
  out.cx_px = (camera.cx_px + 0.5) * sx - 0.5;
  out.cy_px = (camera.cy_px + 0.5) * sy - 0.5;
  return out;
}

// The value, or an Error that names `what` ("calib.yml: the left camera"), the implausible value
// and the cure.
Result<Pinhole> checked(const Pinhole& camera, const std::string& what);
Result<StereoRig> checked(const StereoRig& rig, const std::string& what);

// For a picture of this size, scaled where the shapes are the same.
Result<Pinhole> fitted(const Pinhole& camera, int width_px, int height_px, const std::string& what);

}  // namespace dance
