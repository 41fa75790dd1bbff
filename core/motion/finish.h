// Finish: the last step for predicted poses: inertialised corrections, joint limits, turn limits,
// foot lock, unit rotations. A stage has one for each guest (transformers/flow.h).
//
// Units/frames: as core/pose/pose.h; times of the stage's clock.
// Ownership:    plain value; never allocates. Costs 1 to 4 us a frame.
// Threads:      none inside; one owner.
// Failure:      none. A pose that is not predicted, with no correction in progress, is not changed.
#pragma once

#include "core/motion/foot_lock.h"
#include "core/motion/inertializer.h"
#include "core/motion/joint_limits.h"
#include "core/motion/turn_limit.h"

namespace dance {

class Finish {
 public:
  explicit Finish(Duration half_life = Inertializer::kHalfLife) : corrections_(half_life) {}

  void set_body(const Skeleton& skeleton) { feet_.set_body(skeleton); }
  void set_half_life(Duration half_life) { corrections_.set_half_life(half_life); }

  // See Inertializer::add().
  void correct(MonoTime now, const Pose& was, const Pose& is) { corrections_.add(now, was, is); }
  void correct(MonoTime now, const Pose& was_before, const Pose& was, const Pose& is_before,
               const Pose& is, Duration step) {
    corrections_.add(now, was_before, was, is_before, is, step);
  }

  // The poses that arrived, for foot lock to detect standing feet. Optional.
  void observe(const Pose& real, MonoTime now) { feet_.observe(real, now); }

  // See FootLock::foresee(): before the apply() of that pose. Optional.
  void foresee(const Pose& before, const Pose& there, const Pose& after, Duration ahead) {
    feet_.foresee(before, there, after, ahead);
  }

  // Once a frame. `is_predicted`: the pose was not danced so, or not yet.
  void apply(MonoTime now, Pose& pose, bool is_predicted) {
    corrections_.apply(now, pose);
    const bool is_free = is_predicted || !corrections_.is_at_rest();
    if (is_predicted) limit_joints(pose);
    bool is_changed = turns_.apply(now, pose, is_free) || is_free;
    is_changed = feet_.apply(now, pose, is_free) || is_changed;
    if (is_changed) normalize(pose);
  }

  // Another dancer, or the same one anew: nothing is taken over.
  void clear() {
    corrections_.clear();
    turns_.clear();
    feet_.clear();
  }

  const Inertializer& corrections() const { return corrections_; }
  const FootLock& feet() const { return feet_; }

 private:
  Inertializer corrections_;
  TurnLimit turns_;
  FootLock feet_;
};

}  // namespace dance
