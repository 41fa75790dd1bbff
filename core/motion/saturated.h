// saturated: limits the length of a vector softly. Up to two thirds of the limit it changes by less
// than half a per cent.
//
// Units/frames: those of `most`.
// Ownership:    plain values.
// Threads:      any.
// Failure:      none.
#pragma once

#include <Eigen/Core>
#include <cmath>

namespace dance {

// v / (1 + |v / most|⁸)^(1/8)
inline Eigen::Vector3f saturated(const Eigen::Vector3f& v, float most) {
  const float size2 = v.squaredNorm() / (most * most);
  const float size8 = size2 * size2 * size2 * size2;
  return v / std::sqrt(std::sqrt(std::sqrt(1.0f + size8)));
}

}  // namespace dance
