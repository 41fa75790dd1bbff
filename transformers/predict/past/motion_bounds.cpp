#include "transformers/predict/past/motion_bounds.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "transformers/predict/model/body_net.h"
#include "transformers/predict/model/row_kernels.h"

namespace dance {
namespace {

// A joint turns, and the hips get, no further than this at once and this each second. Dancers spin
// faster than joints turn, and on and on.
constexpr float kFurthestTurn_rad = 3.0f;
constexpr float kMostTurn_rad_s = 16.0f;
constexpr float kFurthestWay_m = 3.0f;
constexpr float kSwiftestWay_m_s = 8.0f;
constexpr float kFreeTurn_rad = 0.2f;
constexpr float kSuddenWay_m = 0.1f;
constexpr float kSwiftestSpin_rad_s = 20.0f;
// Of a slope, which is gone on along: a hand is flung faster than 9 rad/s, but not for as long as
// is predicted.
constexpr float kSteadyTurn_rad_s = 9.0f;

using Bounds = std::array<float, kRowGroups>;

Bounds bounds_of(float turn_rad, float way_m, float spin_rad) {
  Bounds most;
  most.fill(turn_rad);
  most[kPlaceGroup] = way_m;
  most[kHeadingGroup] = spin_rad;
  return most;
}

DANCE_WIDE_VECTORS void bound_groups(const Bounds& most, BodyRow& way) {
  Bounds size;
  int beyond = 0;
  for (std::size_t g = 0; g < kRowGroups; ++g) {
    size[g] = std::sqrt(way(g, 0) * way(g, 0) + way(g, 1) * way(g, 1) + way(g, 2) * way(g, 2));
    beyond |= size[g] > most[g] ? 1 : 0;
  }
  if (beyond == 0) return;
  for (std::size_t g = 0; g < kRowGroups; ++g) {
    if (size[g] <= most[g]) continue;
    for (std::size_t axis = 0; axis < 3; ++axis) way(g, axis) *= most[g] / size[g];
  }
}

DANCE_WIDE_VECTORS bool is_finite(const BodyRow& way) {
  int beyond = 0;
  // False for NaN.
  for (const float x : way.v) beyond |= std::abs(x) <= std::numeric_limits<float>::max() ? 0 : 1;
  return beyond == 0;
}

}  // namespace

bool bound_motion(std::size_t horizon, BodyRow& way) {
  if (!is_finite(way)) {
    way.v.fill(0.0f);
    return false;
  }
  const auto seconds = static_cast<float>(kHorizonFrames[horizon] / kGridHz);
  const float turn_rad = std::min(kFurthestTurn_rad, kFreeTurn_rad + kMostTurn_rad_s * seconds);
  const float way_m = std::min(kFurthestWay_m, kSuddenWay_m + kSwiftestWay_m_s * seconds);
  bound_groups(bounds_of(turn_rad, way_m, kFreeTurn_rad + kSwiftestSpin_rad_s * seconds), way);
  return true;
}

void bound_slope(BodyRow& slope) {
  constexpr auto kHz = static_cast<float>(kGridHz);
  bound_groups(
      bounds_of(kSteadyTurn_rad_s / kHz, kSwiftestWay_m_s / kHz, kSwiftestSpin_rad_s / kHz), slope);
}

}  // namespace dance
