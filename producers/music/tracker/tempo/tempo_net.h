// TempoNet: a small network that says how likely dancers would step at a tempo, by what of the
// rhythm comes back after parts of its beat and some of its beats. It separates the levels of a
// rhythm, as 96 and 192 beats a minute, where both explain its strokes.
//
// Units/frames: the logarithm of a likelihood ratio.
// Ownership:    plain value, some 16 kB; judge() allocates nothing.
// Threads:      none inside; const calls may run at the same time.
// Failure:      none.
#pragma once

#include <Eigen/Core>
#include <span>

#include "producers/music/tracker/tempo/rhythm_periods.h"

namespace dance {

struct TempoNet {
  static constexpr int kInputs = static_cast<int>(RhythmPeriods::kCount);
  static constexpr int kHidden = 24;
  static constexpr int kAnswers = 2;  // it is the beat, it is not
  using Input = Eigen::Matrix<float, kInputs, 1>;
  using Hidden = Eigen::Matrix<float, kHidden, 1>;
  using Answer = Eigen::Matrix<float, kAnswers, 1>;

  Eigen::Matrix<float, kHidden, Eigen::Dynamic> in =
      Eigen::Matrix<float, kHidden, Eigen::Dynamic>::Zero(kHidden, kInputs);
  Hidden in_bias = Hidden::Zero();
  Eigen::Matrix<float, kAnswers, kHidden> out = Eigen::Matrix<float, kAnswers, kHidden>::Zero();
  Answer out_bias = Answer::Zero();

  float judge(std::span<const float, RhythmPeriods::kCount> values) const;
};

}  // namespace dance
