#include "transformers/timeline.h"

namespace dance {

DancerTimeline::Taken DancerTimeline::take(const Pose& pose, MonoTime now) {
  bool restarts = false;
  if (!poses_.empty()) {
    restarts =
        pose.clock_id != newest().clock_id || pose.capture_time < newest().capture_time - kJumpBack;
    if (restarts) {
      ++counters_.restarts;
      poses_.clear();
    }
  }
  const MonoTime before = poses_.empty() ? pose.capture_time : newest().capture_time;
  if (!poses_.push(pose)) {
    ++counters_.refused;
    return Taken::kRefused;
  }
  arrived_ = now;
  gap_ = pose.capture_time - before;
  return restarts ? Taken::kRestarted : Taken::kTaken;
}

bool DancerTimeline::set_body(const Skeleton& skeleton) {
  if (!is_valid(skeleton)) return false;
  body_ = skeleton;
  return true;
}

}  // namespace dance
