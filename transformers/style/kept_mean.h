// KeptMean: what has to be taken off, that nothing is left in the mean. An average that follows is
// behind, and what it is behind by stays in the mean of what it is taken off; that is averaged once
// more and taken off, too.
//
// Units/frames: those of what is averaged.
// Ownership:    plain value.
// Threads:      none inside.
// Failure:      none.
// Source:       twicing: Tukey, Exploratory Data Analysis, 1977.
#pragma once

#include <Eigen/Core>

namespace dance {

struct KeptMean {
  Eigen::Vector3f once = Eigen::Vector3f::Zero();
  Eigen::Vector3f missed = Eigen::Vector3f::Zero();

  // `share` of the new counts.
  void follow(const Eigen::Vector3f& value, float share) {
    once += share * (value - once);
    missed += share * (value - once - missed);
  }
  Eigen::Vector3f value() const { return once + missed; }
};

}  // namespace dance
