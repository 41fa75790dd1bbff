// StrokeNet: a small network that classifies a moment as a beat, the half between two beats, or
// neither. Drums may strike on both; which drum it is, and what changes with it, separates them
// more often than not, and a bar pointer accumulates that over many bars.
//
// Units/frames: logarithms of likelihood ratios.
// Ownership:    plain value, some 28 kB; judge() allocates nothing.
// Threads:      none inside; const calls may run at the same time.
// Failure:      none.
#pragma once

#include <Eigen/Core>
#include <span>

#include "producers/music/tracker/stroke_features.h"

namespace dance {

// How much likelier what is heard is on a beat, or on the half after one, than elsewhere.
struct StrokeMeaning {
  float beat = 0.0f;
  float half = 0.0f;
};

struct StrokeNet {
  static constexpr int kInputs = static_cast<int>(StrokeFeatures::kCount);
  static constexpr int kHidden = 32;
  static constexpr int kAnswers = 3;  // beat, half, neither
  using Input = Eigen::Matrix<float, kInputs, 1>;
  using Hidden = Eigen::Matrix<float, kHidden, 1>;
  using Answer = Eigen::Matrix<float, kAnswers, 1>;

  Eigen::Matrix<float, kHidden, Eigen::Dynamic> in =
      Eigen::Matrix<float, kHidden, Eigen::Dynamic>::Zero(kHidden, kInputs);
  Hidden in_bias = Hidden::Zero();
  Eigen::Matrix<float, kAnswers, kHidden> out = Eigen::Matrix<float, kAnswers, kHidden>::Zero();
  Answer out_bias = Answer::Zero();

  StrokeMeaning judge(std::span<const float, StrokeFeatures::kCount> features) const;
};

}  // namespace dance
