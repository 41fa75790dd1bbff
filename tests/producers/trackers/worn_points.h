// Devices on a body whose pose is known, for tests of what finds the body again.
//
// Units/frames: as producers/trackers/tracker_frame.h.
// Ownership:    plain values.
// Threads:      none inside.
// Failure:      none.
#pragma once

#include <vector>

#include "core/motion/rotation_vector.h"
#include "core/pose/heading.h"
#include "core/pose/kinematics.h"
#include "producers/salsa/salsa_dancer.h"
#include "producers/trackers/tracker_body.h"

namespace dance {

constexpr std::uint32_t kThreePoints = 0b111, kFourPoints = 0b1111, kSixPoints = 0b111111,
                        kTenPoints = 0b1111111111;

// Head and hands as usual; the others turned and shifted, each differently.
inline std::array<Mount, kTrackedPointCount> some_mounts(float height_m) {
  std::array<Mount, kTrackedPointCount> mounts;
  for (std::size_t i = 0; i < kTrackedPointCount; ++i) {
    mounts[i] = nominal_mount(static_cast<TrackedPoint>(i), height_m);
    if (mounts[i].is_known) continue;
    const auto n = static_cast<float>(i);
    mounts[i].R_BT = exp_rotation({0.3f * n, 1.1f - 0.2f * n, 0.5f});
    mounts[i].p_BT_m = {0.0f, 0.02f, 0.05f};
    mounts[i].is_known = true;
  }
  return mounts;
}

struct WornPoints {
  explicit WornPoints(const Skeleton& skeleton, std::uint32_t worn = kSixPoints)
      : body(skeleton), points(worn), mounts(some_mounts(standing_height_m(skeleton))) {}

  TrackerFrame see(const Pose& pose, MonoTime time) const {
    BodyFrames frames;
    forward_kinematics(body, pose, frames);
    TrackerFrame frame;
    frame.time = time;
    for (std::size_t i = 0; i < kTrackedPointCount; ++i) {
      if ((points >> i & 1u) == 0) continue;
      const std::size_t b = index_of(kPointBones[i]);
      const Place device = device_place(mounts[i], {frames.p_WB_m[b], frames.R_WB[b]});
      frame.put(static_cast<TrackedPoint>(i), device.p_W_m, device.R_W);
    }
    return frame;
  }

  Skeleton body;
  std::uint32_t points;
  std::array<Mount, kTrackedPointCount> mounts;
};

inline Pose standing(const Skeleton& skeleton, float heading = 0.0f) {
  Pose pose;
  pose.p_WH_m = {0.0f, skeleton.hips_height_m(), 0.0f};
  pose.R_PB[0] = about_up(heading);
  return pose;
}

inline MonoTime at_seconds(double s) { return MonoTime() + Duration::seconds(1.0 + s); }

// Stands in T-pose until the solver has seen it; returns the seconds that took.
inline double stand_in_t_pose(TrackerBody& solver, const WornPoints& worn, double hz = 90.0,
                              float heading = 0.0f) {
  Pose pose;
  double t = 0.0;
  for (; t < 1.2; t += 1.0 / hz)
    solver.solve(worn.see(standing(worn.body, heading), at_seconds(t)), pose);
  return t;
}

// A second dancer for every seed; `t` in seconds.
inline SalsaDancer some_dancer() {
  SalsaStyle style;
  style.role = SalsaRole::kLead;
  return SalsaDancer{style};
}

inline float furthest_joint_m(const BodyFrames& a, const BodyFrames& b) {
  float most = 0.0f;
  for (std::size_t i = 0; i < kBoneCount; ++i)
    most = std::max(most, (a.p_WB_m[i] - b.p_WB_m[i]).norm());
  return most;
}

}  // namespace dance
