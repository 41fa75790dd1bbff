#include "producers/camera/stereo/stereo_rig.h"

#include <fmt/format.h>

#include <Eigen/LU>
#include <cmath>

namespace dance {
namespace {

constexpr int kMostPixels = 16384;
constexpr const char* kCalibrateAgain = "calibrate again with dance capture --calibrate";

bool is_within(double value, double low, double high) { return value >= low && value <= high; }

}  // namespace

Result<Pinhole> checked(const Pinhole& camera, const std::string& what) {
  const double w = camera.width_px;
  const double h = camera.height_px;
  if (!is_within(w, 16, kMostPixels) || !is_within(h, 16, kMostPixels))
    return fail(
        fmt::format("{}: a picture of {} x {} pixels; say the size that it was calibrated with",
                    what, camera.width_px, camera.height_px));
  // Between a fisheye, which five coefficients do not describe, and a telescope.
  for (const auto& [name, f] : {std::pair{"fx", camera.fx_px}, std::pair{"fy", camera.fy_px}})
    if (!is_within(f, 0.2 * w, 20.0 * w))
      return fail(fmt::format("{}: {} is {} pixels at a width of {}; {}", what, name, f,
                              camera.width_px, kCalibrateAgain));
  if (!is_within(camera.cx_px, 0.0, w) || !is_within(camera.cy_px, 0.0, h))
    return fail(fmt::format("{}: its middle ({}, {}) lies outside the picture; {}", what,
                            camera.cx_px, camera.cy_px, kCalibrateAgain));
  for (double k : camera.distortion)
    if (!is_within(k, -100.0, 100.0))
      return fail(fmt::format("{}: a distortion coefficient is {}; {}", what, k, kCalibrateAgain));
  return camera;
}

Result<StereoRig> checked(const StereoRig& rig, const std::string& what) {
  DANCE_TRY(const Pinhole left, checked(rig.left, what + ": the left camera"));
  DANCE_TRY(const Pinhole right, checked(rig.right, what + ": the right camera"));
  if (left.width_px != right.width_px || left.height_px != right.height_px)
    return fail(
        fmt::format("{}: the cameras' pictures differ in size ({} x {}, {} x {}); set both "
                    "cameras to the same and calibrate again",
                    what, left.width_px, left.height_px, right.width_px, right.height_px));
  if (!rig.R_RL.allFinite() ||
      !(rig.R_RL * rig.R_RL.transpose()).isApprox(Eigen::Matrix3d::Identity(), 1e-3) ||
      rig.R_RL.determinant() < 0.0)
    return fail(fmt::format("{}: R is no rotation; {}", what, kCalibrateAgain));
  if (!rig.p_RL_m.allFinite() || !is_within(rig.baseline_m(), 0.01, 2.0))
    return fail(
        fmt::format("{}: the cameras are {} m apart (T is in metres: divide millimetres by "
                    "1000); between 0.01 and 2 can be used",
                    what, rig.baseline_m()));
  if (rig.p_RL_m.x() > 0.0)
    return fail(what + ": the right camera stands left of the left one; swap the two");
  if (-rig.p_RL_m.x() < 0.9 * rig.baseline_m())
    return fail(
        what +
        ": the cameras do not stand side by side; mount them in one row, and calibrate again");
  // Cameras turned by more than this have little in common in their pictures.
  if (rig.R_RL.trace() < 1.0 + 2.0 * std::cos(0.5))
    return fail(what +
                ": the cameras are turned by more than 28 degrees; mount them parallel, and "
                "calibrate again");
  return rig;
}

Result<Pinhole> fitted(const Pinhole& camera, int width_px, int height_px,
                       const std::string& what) {
  if (width_px == camera.width_px && height_px == camera.height_px) return camera;
  // The same shape to within the rounding of a row.
  const double rows = static_cast<double>(camera.height_px) * width_px / camera.width_px;
  if (std::abs(rows - height_px) > 1.0)
    return fail(
        fmt::format("{} was made at {} x {}, and the camera gives {} x {}, which is another "
                    "shape of picture; calibrate again at this size, or choose a size of the "
                    "same shape",
                    what, camera.width_px, camera.height_px, width_px, height_px));
  return resized(camera, width_px, height_px);
}

}  // namespace dance
