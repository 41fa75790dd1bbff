// Spring: an offset that decays, critically damped: x(t) = (x + (v + y x) t) e^(-y t). It does not
// overshoot, and does not depend on the frame rate.
//
// Units/frames: the caller's; y in 1/s.
// Ownership:    plain value.
// Threads:      none inside.
// Failure:      none.
#pragma once

#include <Eigen/Core>
#include <cmath>

#include "core/base/time.h"

namespace dance {

struct Spring {
  Eigen::Vector3f offset = Eigen::Vector3f::Zero();
  Eigen::Vector3f velocity = Eigen::Vector3f::Zero();

  // The y for this half-life of an offset at rest: (1 + x) e^-x = 1/2.
  static float y_of_half_life(Duration half_life) {
    return static_cast<float>(1.67834699001666 / half_life.as_seconds());
  }

  void advance(float y, float seconds) {
    const float fade = std::exp(-y * seconds);
    const Eigen::Vector3f pull = velocity + y * offset;
    offset = fade * (offset + seconds * pull);
    velocity = fade * (velocity - (y * seconds) * pull);
  }

  // Less than is visible.
  bool is_at_rest() const {
    return offset.cwiseAbs().maxCoeff() < 1e-5f && velocity.cwiseAbs().maxCoeff() < 1e-4f;
  }
};

}  // namespace dance
