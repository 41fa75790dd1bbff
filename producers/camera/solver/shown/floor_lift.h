// FloorLift: the whole shown body, raised so that no sole is below the floor: what legs did not
// reach, bones that arrive, a body whose legs are guessed. As long as the floor is not known, it is
// taken to be under the lowest joint or sole; where that rises, the floor follows slowly: a dancer
// who jumps leaves it.
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
  float floor_m_ = 0.0f;  // as it seems, as long as it is not known
  bool is_first_ = true;
};

}  // namespace dance
