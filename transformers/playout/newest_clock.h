// NewestClock: shows the newest pose as it came, at once. For routes in which nothing waits for a
// pose, predicts one or continues the dance.
//
// Units/frames: as transformers/playout/playout_clock.h.
// Ownership:    none.
// Threads:      none inside; one owner.
// Failure:      none.
#pragma once

#include "transformers/playout/playout_clock.h"

namespace dance {

class NewestClock : public PlayoutClock {
 public:
  void observe(const DancerTimeline& /*timeline*/, MotionSource& /*source*/) override {}
  void restart() override {}
  Choice choose(const DancerTimeline& timeline, MonoTime /*now*/, MonoTime /*shown*/) override {
    return {timeline.newest().capture_time, {}, false};
  }
};

}  // namespace dance
