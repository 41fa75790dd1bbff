// Inertializer: smooth corrections without delay. At a discontinuity (a new prediction, a loop that
// wraps, poses that resume) the difference is kept as an offset per bone that decays as a
// critically damped spring.
//
// Units/frames: offsets are rotation vectors in each bone's parent (hips: in W) and metres in W;
//               half-lives are of an offset at rest. Times are of the stage's clock.
// Ownership:    plain value; never allocates.
// Threads:      none inside; one owner.
// Failure:      none. Time that does not advance leaves the offsets unchanged. A jump of the hips
//               beyond kFurthest_m is shown at once, and counted.
// Source:       Bollo, Inertialization: High-Performance Animation Transitions in Gears of War, GDC
//               2018; the spring instead of its polynomial after Holden, Spring-It-On, 2021.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>

#include "core/base/time.h"
#include "core/motion/spring.h"
#include "core/pose/pose.h"

namespace dance {

class Inertializer {
 public:
  static constexpr Duration kHalfLife = Duration::ms(60);
  static constexpr float kFurthest_m = 4.0f;

  explicit Inertializer(Duration half_life = kHalfLife);
  void set_half_life(Duration half_life);
  Duration half_life() const { return half_life_; }

  // At `now` the source changes from `was` to `is`: both of the same moment of the dance, both
  // without what apply() adds. Earlier offsets stay.
  void add(MonoTime now, const Pose& was, const Pose& is);
  // The same, keeping the speed too, from the poses a Duration `step` before on either side.
  void add(MonoTime now, const Pose& was_before, const Pose& was, const Pose& is_before,
           const Pose& is, Duration step);

  // Adds the offsets at `now`. Without any the pose is not changed.
  void apply(MonoTime now, Pose& pose);

  bool is_at_rest() const { return at_rest_; }
  void clear();
  std::uint64_t jumps() const { return jumps_; }

 private:
  void advance_to(MonoTime now);
  void add_speed(Spring& spring, const Eigen::Vector3f& velocity, float most) const;
  void set_decay();

  Duration half_life_;
  float y_ = 0.0f;      // 1/s, of the half-life
  float decay_ = 0.0f;  // the one in use: slower for large offsets
  std::array<Spring, kBoneCount> rotations_;
  Spring hips_;
  MonoTime time_;
  bool at_rest_ = true;
  std::uint64_t jumps_ = 0;
};

}  // namespace dance
