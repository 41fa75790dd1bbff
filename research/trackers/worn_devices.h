// WornDevices: headset, controllers and trackers as a dancer wears them: each a little elsewhere
// than usual, or strapped on anyhow, and measured with noise. And a T-pose as people stand in one.
//
// Units/frames: as producers/trackers/tracker_frame.h.
// Ownership:    plain value.
// Threads:      none inside; one owner.
// Failure:      none.
// Source:       noise of tracked devices: Niehorster, Li and Lappe, i-Perception 2017 (jitter below
//               0.2 mm); the slow part stands for what lighthouses and cameras disagree about.
#pragma once

#include "core/base/random.h"
#include "core/pose/kinematics.h"
#include "producers/trackers/tracker_mounts.h"

namespace dance {

class WornDevices {
 public:
  WornDevices(const Skeleton& body, std::uint32_t points, std::uint64_t seed);

  // What the devices say of this pose, one frame of 1/hz after another.
  TrackerFrame see(const Pose& pose, double hz);
  const Mount& mount(TrackedPoint point) const { return mounts_[index_of(point)]; }

 private:
  using Wander = std::array<Eigen::Vector3f, 2>;

  Eigen::Vector3f vector(double sd);
  void wander(Wander& slow, double keep, double sd);
  Mount strapped(TrackedPoint point);

  Skeleton body_;
  std::uint32_t points_;
  Random random_;
  std::array<Mount, kTrackedPointCount> mounts_;
  std::array<Wander, kTrackedPointCount> slow_m_, slow_rad_;
};

// The bits of 3, 4, 6 or 10 points.
std::uint32_t point_set(int count);

// Somebody who has been asked to stand in T-pose here, looking this way: arms not quite level,
// elbows not quite straight, toes out.
Pose human_t_pose(const Skeleton& body, const Eigen::Vector3f& hips_m, float heading_rad,
                  Random& random);

}  // namespace dance
