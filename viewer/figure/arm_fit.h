// Brings the palms of a figure to places: by the arm, the hand turned as danced; where that does
// not reach by the shoulder, then by a lean of the back, then by a slightly longer arm, each within
// a bound.
//
// Units/frames: metres in W.
// Ownership:    changes the figure's frames; no allocation.
// Threads:      none inside.
// Failure:      none: what is beyond all bounds is pointed at.
#pragma once

#include <optional>

#include "viewer/figure/figure_fit.h"

namespace dance {

constexpr float kMostStretch = 1.08f;

// How far the wrist gets from where the upper arm begins, and what the rest may add.
float arm_reach_m(const FigureFit& fit, std::size_t side);
float arm_help_m(const FigureFit& fit, std::size_t side);

// Palms without a place stay as they are.
void fit_arms(const std::array<std::optional<Eigen::Vector3f>, 2>& palms_W_m, FigureFit& fit);

}  // namespace dance
