#include "testing/camera/drawn_rig.h"

#include <Eigen/Geometry>

#include "core/base/random.h"

namespace dance {
namespace {

Eigen::Matrix3d turn(const Eigen::Vector3d& rodrigues) {
  return Eigen::AngleAxisd(rodrigues.norm(), rodrigues.normalized()).toRotationMatrix();
}

}  // namespace

StereoRig drawn_rig() {
  StereoRig rig;
  rig.left = {1280, 720, 700.2, 699.6, 652.3, 351.8, {-0.172, 0.026, 0.0006, -0.0004, 0.0}, true};
  rig.right = {1280, 720, 698.9, 699.1, 645.1, 367.4, {-0.170, 0.025, -0.0003, 0.0005, 0.0}, true};
  rig.R_RL = turn({0.0041, 0.0118, -0.0023});
  rig.p_RL_m = {-0.1198, 0.0003, -0.0011};
  return rig;
}

StereoRig calibrated_rig(const StereoRig& truth, std::uint64_t seed) {
  Random random(seed + 99);
  StereoRig rig = truth;
  for (Pinhole* eye : {&rig.left, &rig.right}) {
    const double stretch = 1.0 + 0.001 * random.normal();
    eye->fx_px *= stretch;
    eye->fy_px *= stretch;
    eye->cx_px += 0.3 * random.normal();
    eye->cy_px += 0.3 * random.normal();
    eye->distortion[0] += 0.002 * random.normal();
  }
  // A turn about y shifts all disparities alike: 0.0002 rad are 0.14 px.
  const Eigen::Vector3d bend(0.0004 * random.normal(), 0.0002 * random.normal(),
                             0.0004 * random.normal());
  rig.R_RL = turn(bend) * rig.R_RL;
  // What the eyes' own errors have in common with the turn, a calibration of the pair makes good.
  rig.right.cx_px += rig.left.cx_px - truth.left.cx_px - (rig.right.cx_px - truth.right.cx_px);
  rig.p_RL_m *= 1.0 + 0.001 * random.normal();
  return rig;
}

}  // namespace dance
