#include "producers/camera/region/tracked_region.h"

#include <algorithm>
#include <cmath>

#include "producers/camera/region/picture_region.h"

namespace dance {

using Eigen::Vector2f;
using Eigen::Vector3f;

bool is_same_part(std::span<const Vector3f> image_px, const BodyRegion& around,
                  const BodyRegion& found, const TrackingLimits& limits) {
  if (std::abs(within_half_turns(around.turn_rad - found.turn_rad)) > limits.turn_rad) return false;
  const RegionFrame frame(found);
  const Vector2f moved = frame.offset(centre_of(around));
  if (moved.cwiseAbs().maxCoeff() > limits.move * found.side_px) return false;
  if (std::abs(around.side_px - found.side_px) > limits.growth * found.side_px) return false;
  const float reach = 0.5f * (1.0f + limits.margin) * found.side_px;
  return std::all_of(image_px.begin(), image_px.end(), [&](const Vector3f& p) {
    return frame.offset(p.head<2>()).cwiseAbs().maxCoeff() < reach;
  });
}

}  // namespace dance
