#include "producers/xr/xr_dancer.h"

namespace dance {

bool XrDancer::find(const XrSight& sight, Pose& pose) {
  if (sight.has_figure && figure_.fit(sight.figure, pose)) {
    pose.capture_time = sight.figure_moment;
    pose.confidence = 1.0f;
    figure_seen_ = sight.points.time;
    is_figure_ = true;
    return true;
  }
  if (is_figure_ && sight.points.time - figure_seen_ < kWaitsForBody) return false;
  if (!body_.solve(sight.points, pose)) return false;
  is_figure_ = false;
  return true;
}

bool XrDancer::solve(const XrSight& sight, Pose& pose) {
  const bool was_figure = is_figure_;
  if (!find(sight, pose)) return false;
  const MonoTime now = sight.points.time;
  if (has_solved_ && was_figure != is_figure_) bridge_.add(now, last_, pose);
  last_ = pose;
  has_solved_ = true;
  bridge_.apply(now, pose);
  return true;
}

}  // namespace dance
