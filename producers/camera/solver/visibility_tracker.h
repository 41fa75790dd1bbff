// VisibilityTracker: how long each part of the body has been hidden, the pose's presence bits that
// follow, and a smooth transition for parts that reappear.
//
// Units/frames: seconds; bones and confidence of core/pose/pose.h.
// Ownership:    plain value, no heap.
// Threads:      none inside; one owner.
// Failure:      none.
#pragma once

#include <array>

#include "core/motion/inertializer.h"
#include "producers/camera/solver/motion_filter.h"

namespace dance {

class VisibilityTracker {
 public:
  void clear();
  void follow(const PartVisibility& visibility, double seconds);
  // Parts that reappeared in this picture are blended from `carried`, their predicted pose.
  void blend(MonoTime now, const Pose& carried, Pose& pose);
  // The whole body, where it is found again or grows to its true size.
  void blend_all(MonoTime now, const Pose& carried, const Pose& pose) {
    blend_.add(now, carried, pose);
  }
  void apply(MonoTime now, Pose& pose) { blend_.apply(now, pose); }

  std::uint32_t presence() const;

 private:
  Inertializer blend_{Duration::ms(80)};
  std::array<double, kPartCount> hidden_s_{};
  std::array<bool, kPartCount> reappeared_{};
};

}  // namespace dance
