// A body that stands: hips one metre up, ankles 8 cm and balls 2 cm above the floor, a foot a
// hand's breadth to each side.
//
// Units/frames: metres in W, +Y up, facing +Z.
// Ownership:    plain values.
// Threads:      any.
// Failure:      none.
#pragma once

#include "transformers/style/swing_feet.h"

namespace dance {

inline BodyFrames on_its_feet() {
  BodyFrames frames;
  for (Eigen::Vector3f& p : frames.p_WB_m) p = Eigen::Vector3f(0.0f, 1.0f, 0.0f);
  for (Eigen::Quaternionf& R : frames.R_WB) R.setIdentity();
  for (std::size_t side = 0; side < kSwingLegs.size(); ++side) {
    const std::size_t ankle = ankle_of(side);
    const float aside = side == 0 ? 0.1f : -0.1f;
    frames.p_WB_m[ankle] = Eigen::Vector3f(aside, 0.08f, 0.0f);
    frames.p_WB_m[ankle + 1] = Eigen::Vector3f(aside, 0.02f, 0.12f);
  }
  return frames;
}

}  // namespace dance
