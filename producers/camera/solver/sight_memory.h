// SightMemory: how long each part of the body has not been seen, what a pose says of that, and a
// soft way back for what is seen again.
//
// Units/frames: seconds; bones and confidence of core/pose/pose.h.
// Ownership:    plain value, no heap.
// Threads:      none inside; one owner.
// Failure:      none.
#pragma once

#include <array>

#include "core/motion/inertializer.h"
#include "producers/camera/solver/motion_memory.h"

namespace dance {

class SightMemory {
 public:
  void clear();
  void follow(const PartSight& sight, double seconds);
  // Parts that came back with the picture just followed are shown from `carried` on, where they
  // were, to where they are.
  void blend(MonoTime now, const Pose& carried, Pose& pose);
  // The whole body, where it is found anew or grows to its true size.
  void blend_all(MonoTime now, const Pose& carried, const Pose& pose) {
    blend_.add(now, carried, pose);
  }
  void apply(MonoTime now, Pose& pose) { blend_.apply(now, pose); }

  std::uint32_t presence() const;

 private:
  Inertializer blend_{Duration::ms(80)};
  std::array<double, kPartCount> unseen_s_{};
  std::array<bool, kPartCount> is_back_{};
};

}  // namespace dance
