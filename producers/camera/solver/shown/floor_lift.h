// FloorLift: the whole shown body, raised so that no sole is below the floor: what legs did not
// reach, bones that arrive, a body whose legs are out of the picture. A dancer whose floor is not
// known yet stands on it.
//
// Units/frames: metres in W, floor at y = 0; seconds.
// Ownership:    plain value, no heap.
// Threads:      none inside; one owner.
// Failure:      none.
#pragma once

#include "core/motion/spring.h"
#include "core/pose/kinematics.h"
#include "producers/camera/solver/body_shape.h"

namespace dance {

// The lowest of heel, ball and toes of a foot.
float lowest_of_foot_m(const BodyShape& shape, const BodyFrames& frames, std::size_t side);

class FloorLift {
 public:
  void clear() { *this = FloorLift(); }
  void apply(const BodyShape& shape, bool has_floor, double seconds, Pose& pose);

 private:
  Spring lift_;
  bool is_first_ = true;
};

}  // namespace dance
