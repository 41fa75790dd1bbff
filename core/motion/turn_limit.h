// TurnLimit: limits the angular speed of joints in predicted poses, so that an outlier of the
// sensor or an ambiguous joint angle does not throw a limb within a frame. The remainder follows in
// the next frames.
//
// Units/frames: turns of each bone in its parent; times of the stage's clock.
// Ownership:    plain value; never allocates. Costs about 0.1 us a frame.
// Threads:      none inside; one owner.
// Failure:      none. After a gap in time nothing is limited.
// Source:       CMU motion capture (mocap.cs.cmu.edu), subjects 60, 61 and 131: 99.9 % of all
//               frames are below.
#pragma once

#include "core/base/time.h"
#include "core/pose/pose.h"

namespace dance {

class TurnLimit {
 public:
  static constexpr float kFastest_rad_s = 16.0f;
  static constexpr float kFastestHand_rad_s = 30.0f;

  // Once a frame; repeating a moment gives the same result. Poses that arrived are not changed,
  // unless a limb still lags. Returns whether the pose was changed.
  bool apply(MonoTime now, Pose& pose, bool is_predicted);
  void clear() { is_behind_ = false, time_ = MonoTime(); }

 private:
  BoneRotations shown_ = identity_rotations();
  MonoTime time_;
  bool is_behind_ = false;
};

}  // namespace dance
