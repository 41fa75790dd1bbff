// FloorFeet: foot locking for the shown pose: a standing ball does not slide, and no part of a foot
// is below the floor. The legs are solved again for it; the correction decays when a foot lifts.
//
// Units/frames: metres in W, floor at y = 0.
// Ownership:    plain value, no heap.
// Threads:      none inside; one owner.
// Failure:      a leg is not stretched beyond its reach: then the foot slides.
#pragma once

#include <array>

#include "core/motion/spring.h"
#include "core/pose/kinematics.h"
#include "producers/camera/solver/body_shape.h"
#include "producers/camera/solver/sole_contacts.h"

namespace dance {

class FloorFeet {
 public:
  void clear() {
    feet_.fill(Foot());
    drop_ = Spring();
  }
  // `seconds` since the last pose. Without `holds` feet only stay above the floor.
  void apply(const BodyShape& shape, const SoleContacts& contacts, bool has_floor, bool holds,
             double seconds, Pose& pose);

 private:
  struct Foot {
    bool is_held = false;
    Eigen::Vector3f held_W_m = Eigen::Vector3f::Zero();
    Spring shift;
  };
  void lower_hips(const BodyShape& shape, const BodyFrames& like,
                  const std::array<Eigen::Vector3f, 2>& offsets, float step, Pose& pose);

  std::array<Foot, 2> feet_;
  Spring drop_;  // of the hips, so that legs reach
};

}  // namespace dance
