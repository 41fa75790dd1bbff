#include "core/pose/pose.h"

#include <cmath>

namespace dance {
namespace {

bool is_unit(const Eigen::Quaternionf& q) {
  const float n = q.squaredNorm();
  return n > 0.98f && n < 1.02f;  // also false for NaN
}

}  // namespace

bool is_valid(const Pose& pose) {
  for (const auto& q : pose.R_PB)
    if (!is_unit(q)) return false;
  if (!(pose.p_WH_m.cwiseAbs().maxCoeff() <= kMaxStageDistance_m) || !pose.p_WH_m.allFinite())
    return false;
  if (!(pose.confidence >= 0.0f && pose.confidence <= 1.0f)) return false;
  return std::isnan(pose.music_beats) || std::isfinite(pose.music_beats);
}

bool is_valid(const Hands& hands) {
  for (const auto& q : hands.R_PB)
    if (!is_unit(q)) return false;
  return true;
}

void normalize(Pose& pose) {
  for (auto& q : pose.R_PB) q.normalize();
}

void normalize(Hands& hands) {
  for (auto& q : hands.R_PB) q.normalize();
}

}  // namespace dance
