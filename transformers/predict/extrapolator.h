// Extrapolator: what tells the pose of a moment after the newest that came.
//
// Units/frames: as core/pose/pose.h; moments are capture times.
// Ownership:    the motion source owns it; never allocates after construction.
// Threads:      one owner; learner() is for another thread.
// Failure:      none: it is asked only once it has observed a pose.
#pragma once

#include <memory>

#include "core/pose/pose.h"
#include "core/pose/skeleton.h"
#include "transformers/predict/learner.h"

namespace dance {

class Extrapolator {
 public:
  virtual ~Extrapolator() = default;
  // Newer than the one before, unless the source began anew.
  virtual void observe(const Pose& pose, MonoTime now) = 0;
  // `moment` is not before the newest pose. The same for the same moment until the next pose.
  virtual void predict(MonoTime moment, Pose& out) const = 0;
  virtual void set_body(const Skeleton& /*skeleton*/) {}
  // What is too slow for the pose path, if anything.
  virtual std::shared_ptr<Learner> learner() const { return nullptr; }
};

}  // namespace dance
