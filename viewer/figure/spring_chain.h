// SpringChains: hair, ribbons and skirts of one figure that swing. Each node has its end as a mass
// that keeps its distance, is drawn to where it would be at rest, pulled by gravity, slowed by
// drag, and pushed out of the body's colliders.
//
// Steps are of 1/120 s on a grid of the scene's time, the body's motion between two pictures is
// interpolated for them, and what is shown lies between the last two: so hair swings the same at
// any frame rate. After a jump in time or place, or a pause, it is at rest.
//
// Units/frames: metres in W.
// Ownership:    one for each figure; allocates in start() only.
// Threads:      none inside.
// Failure:      none: an end that is no longer finite goes back to rest.
// Source:       VRM 1.0, VRMC_springBone-1.0: Verlet integration, forces for each step of 1/60 s.
#pragma once

#include <span>
#include <vector>

#include "core/base/time.h"
#include "viewer/figure/driver_pose.h"

namespace dance {

class SpringChains {
 public:
  static constexpr Duration kStep = Duration::ns(8'333'333);
  static constexpr Duration kLongestPause = Duration::ms(250);
  static constexpr float kFurthestJump_m = 1.0f;

  // For another rig, or the same anew.
  void start(const AvatarRig& rig);

  // Bones and twist nodes of `drivers` are as they are at `now`; sets those that swing.
  void swing(const AvatarRig& rig, MonoTime now, std::span<DriverPose> drivers);
  // The same at rest: for a figure that there is no time for.
  void stay(const AvatarRig& rig, MonoTime now, std::span<DriverPose> drivers);

  // What a step costs: nodes, and their pairs with colliders.
  std::size_t work() const { return work_; }

 private:
  struct State {
    Eigen::Vector3f end_W_m, end_before_W_m;
    Eigen::Quaternionf turn, turn_before;  // in the parent
    DriverPose centre, pose;               // at the last step
  };

  void rest(const AvatarRig& rig, std::span<const DriverPose> drivers);
  void step(const AvatarRig& rig, float share, std::span<const DriverPose> drivers);
  Eigen::Vector3f end_after(const AvatarRig& rig, const SwingNode& node, const State& state,
                            const Eigen::Vector3f& place, const Eigen::Vector3f& rest, float share,
                            std::span<const DriverPose> drivers) const;
  void show(const AvatarRig& rig, float share, std::span<DriverPose> drivers) const;
  DriverPose between(std::size_t driver, float share, std::span<const DriverPose> drivers) const;

  std::vector<State> states_;
  std::vector<int> state_of_;       // of a driver; -1: it does not swing
  std::vector<DriverPose> before_;  // the drivers of the last picture
  MonoTime time_;
  std::int64_t steps_ = 0;
  std::size_t work_ = 0;
  bool is_moving_ = false;
};

}  // namespace dance
