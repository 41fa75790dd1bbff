#include "producers/camera/hands/tracked_region.h"

#include <algorithm>
#include <cmath>

#include "producers/camera/estimator/region_sampler.h"
#include "producers/camera/hands/half_turn.h"

namespace dance {

using Eigen::Vector2f;
using Eigen::Vector3f;

float within_half_turns(float angle_rad) {
  return angle_rad -
         2.0f * kHalfTurn_rad * std::floor((angle_rad + kHalfTurn_rad) / (2.0f * kHalfTurn_rad));
}

float turn_from_up(const Vector2f& direction) {
  return within_half_turns(0.5f * kHalfTurn_rad - std::atan2(-direction.y(), direction.x()));
}
float turn_from_right(const Vector2f& direction) {
  return within_half_turns(-std::atan2(-direction.y(), direction.x()));
}

Vector2f turned(const Vector2f& v, float turn_rad) {
  const float c = std::cos(turn_rad), s = std::sin(turn_rad);
  return {c * v.x() - s * v.y(), s * v.x() + c * v.y()};
}

bool is_same_part(std::span<const Vector3f> image_px, const BodyRegion& around,
                  const BodyRegion& found, const TrackingLimits& limits) {
  if (std::abs(within_half_turns(around.turn_rad - found.turn_rad)) > limits.turn_rad) return false;
  const Vector2f moved = turned(centre_of(around) - centre_of(found), -found.turn_rad);
  if (moved.cwiseAbs().maxCoeff() > limits.move * found.side_px) return false;
  if (std::abs(around.side_px - found.side_px) > limits.growth * found.side_px) return false;
  const float reach = 0.5f * (1.0f + limits.margin) * found.side_px;
  return std::all_of(image_px.begin(), image_px.end(), [&](const Vector3f& p) {
    return turned(p.head<2>() - centre_of(found), -found.turn_rad).cwiseAbs().maxCoeff() < reach;
  });
}

}  // namespace dance
