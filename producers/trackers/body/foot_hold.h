// FootHold: a foot that nobody measures, from where it probably is and how probably it stands:
// while it stands its ball stays in place, and it steps where it has come to be elsewhere.
//
// Units/frames: W, metres, the floor at 0.
// Ownership:    plain value; never allocates.
// Threads:      none inside; one owner.
// Failure:      none. After a jump of the dancer nothing is held.
#pragma once

#include "core/motion/spring.h"
#include "core/pose/skeleton.h"
#include "producers/trackers/tracker_mounts.h"

namespace dance {

class FootHold {
 public:
  void reset() { *this = FootHold(); }
  bool is_held() const { return is_held_; }

  // `goal` is the foot bone's place, `o_ball` the ball's in it, `rest_m` the height of the ball on
  // the floor. Returns the place to show.
  Place follow(const Place& goal, const Eigen::Vector3f& o_ball, float rest_m, float stands,
               float seconds);

 private:
  bool should_hold(const Eigen::Vector3f& ball, float rest_m, float stands) const;

  Eigen::Vector3f held_ = Eigen::Vector3f::Zero();  // of the ball
  Eigen::Vector3f shown_ = Eigen::Vector3f::Zero();
  Eigen::Vector3f goal_before_ = Eigen::Vector3f::Zero();
  Spring shift_;  // what is added to the goal's ball
  bool is_held_ = false, is_catching_up_ = false, began_ = false;
};

}  // namespace dance
