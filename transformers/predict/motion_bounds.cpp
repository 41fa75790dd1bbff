#include "transformers/predict/motion_bounds.h"

#include <algorithm>
#include <cmath>

#include "transformers/predict/body_net.h"

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

void bound_group(std::size_t g, float most, BodyRow& way) {
  const float size =
      std::sqrt(way(g, 0) * way(g, 0) + way(g, 1) * way(g, 1) + way(g, 2) * way(g, 2));
  if (size <= most) return;
  for (std::size_t axis = 0; axis < 3; ++axis) way(g, axis) *= most / size;
}

}  // namespace

bool bound_motion(std::size_t horizon, BodyRow& way) {
  float sum = 0.0f;
  for (const float x : way.v) sum += x * 0.0f;
  if (sum != 0.0f || std::isnan(sum)) {
    way.v.fill(0.0f);
    return false;
  }
  const auto seconds = static_cast<float>(kHorizonFrames[horizon] / kGridHz);
  const float turn_rad = std::min(kFurthestTurn_rad, kFreeTurn_rad + kMostTurn_rad_s * seconds);
  const float way_m = std::min(kFurthestWay_m, kSuddenWay_m + kSwiftestWay_m_s * seconds);
  for (std::size_t g = 0; g < kBoneCount; ++g) bound_group(g, turn_rad, way);
  bound_group(kPlaceGroup, way_m, way);
  bound_group(kHeadingGroup, kFreeTurn_rad + kSwiftestSpin_rad_s * seconds, way);
  return true;
}

void bound_slope(BodyRow& slope) {
  constexpr auto kHz = static_cast<float>(kGridHz);
  for (std::size_t g = 0; g < kBoneCount; ++g) bound_group(g, kSteadyTurn_rad_s / kHz, slope);
  bound_group(kPlaceGroup, kSwiftestWay_m_s / kHz, slope);
  bound_group(kHeadingGroup, kSwiftestSpin_rad_s / kHz, slope);
}

}  // namespace dance
