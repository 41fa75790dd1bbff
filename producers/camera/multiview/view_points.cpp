#include "producers/camera/multiview/view_points.h"

#include <algorithm>

namespace dance {

using Eigen::Vector3d;

ViewPoints view_points(const Observation& seen, MonoTime time) {
  ViewPoints points;
  points.time = time;
  points.ray_sd = static_cast<float>(seen.ray_sd);
  for (std::size_t i = 0; i < kViewPointCount; ++i) {
    const std::size_t l = index_of(kViewLandmarks[i]);
    points.ray[i] = seen.ray[l].cast<float>();
    points.world_m[i] = seen.world_m[l].cast<float>();
    points.weight[i] = static_cast<float>(std::min(seen.weight[l], seen.world_weight[l]));
  }
  Vector3d hips_m;
  if (seen.is_usable && place_on_rays(seen, seen.world_m, hips_m)) {
    points.hips_m = hips_m.cast<float>();
    points.distance_m = points.hips_m.norm();
  }
  return points;
}

double way_between(const ViewPoints& a, const ViewPoints& b) {
  double sum = 0.0, weights = 0.0;
  for (std::size_t i = 0; i < kViewPointCount; ++i) {
    const double weight = static_cast<double>(std::min(a.weight[i], b.weight[i]));
    sum += weight * static_cast<double>((a.ray[i] - b.ray[i]).norm());
    weights += weight;
  }
  const double sd = static_cast<double>(std::max(a.ray_sd, b.ray_sd));
  return weights > 0.0 && sd > 0.0 ? sum / weights / sd : 0.0;
}

}  // namespace dance
