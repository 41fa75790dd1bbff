// Inertializer: corrections without a pop. Where what is to be shown changes from one frame to the
// next (a prediction anew, a loop that wraps, a dancer who comes back), the difference is kept as
// an offset per bone that dies away as a critically damped spring does; nothing is shown later for
// it, and nothing once the offset is gone.
//
// Units/frames: offsets are rotation vectors in each bone's parent (hips: in W) and metres in W;
//               half-lives are what an offset at rest takes to its half. Times are of the stage's
//               clock.
// Ownership:    plain value; never allocates.
// Threads:      none inside; one owner.
// Failure:      none. Time that does not go on leaves the offsets as they are. Hips that jump
//               further than kFurthest_m are somewhere else: they are shown there at once, and
//               counted.
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

  // At the moment `now`, `was` was to be shown and `is` is from here on: both of the same moment of
  // the dance, and both without what apply() adds. What is left of earlier corrections stays. Two
  // that are the same add nothing.
  void add(MonoTime now, const Pose& was, const Pose& is);
  // The same, and the speed goes on too: the poses a Duration `step` before, on either side.
  void add(MonoTime now, const Pose& was_before, const Pose& was, const Pose& is_before,
           const Pose& is, Duration step);

  // Adds what is left of the offsets at `now`. With nothing left the pose is not touched.
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
  float decay_ = 0.0f;  // the one that is taken: slower for what is far
  std::array<Spring, kBoneCount> rotations_;
  Spring hips_;
  MonoTime time_;
  bool at_rest_ = true;
  std::uint64_t jumps_ = 0;
};

}  // namespace dance
