// MannequinShape: the proportions that a mannequin is made in: a dancer's, rounded, so that small
// changes of a measurement do not make it anew, and equal dancers share one.
//
// Units/frames: as core/pose/skeleton.h, in steps of kShapeStep_m.
// Ownership:    plain value.
// Threads:      none inside.
// Failure:      none.
#pragma once

#include <string>

#include "core/pose/skeleton.h"

namespace dance {

constexpr float kShapeStep_m = 0.005f;

class MannequinShape {
 public:
  MannequinShape() = default;
  MannequinShape(const Skeleton& skeleton, bool has_fingers);

  // Stays as it is while no offset is further than one step from its own.
  bool fits(const Skeleton& skeleton, bool has_fingers) const;
  const Skeleton& skeleton() const { return skeleton_; }
  bool has_fingers() const { return has_fingers_; }
  void append_to(std::string& key) const;

 private:
  Skeleton skeleton_ = average_skeleton();
  bool has_fingers_ = false;
};

}  // namespace dance
