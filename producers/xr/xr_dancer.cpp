#include "producers/xr/xr_dancer.h"

namespace dance {

bool XrDancer::solve(const XrSight& sight, Pose& pose) {
  if (sight.has_figure && figure_.fit(sight.figure, pose)) {
    pose.capture_time = sight.figure_moment;
    is_figure_ = true;
    return true;
  }
  is_figure_ = false;
  return body_.solve(sight.points, pose);
}

}  // namespace dance
