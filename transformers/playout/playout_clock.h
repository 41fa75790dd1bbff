// PlayoutClock: the first question of the stage: which moment of the dance to show. Live shows it
// as new as it is, hold a constant delay later, rhythm where the listener's music stands.
//
// Units/frames: moments are capture times of the dancer's clock; `now` is this house's.
// Ownership:    the flow owns it; never allocates after construction.
// Threads:      none inside; one owner.
// Failure:      none: asked only once the timeline has a pose.
#pragma once

#include "core/base/time.h"
#include "core/signal/flow_setting.h"
#include "core/signal/playout.h"
#include "transformers/motion_source.h"
#include "transformers/timeline.h"

namespace dance {

class PlayoutClock {
 public:
  struct Choice {
    MonoTime moment;
    MonoTime instead_of;  // set where it jumped: the moment that it would have gone on to
    bool stands = false;  // the same moment again, as the delay grew
  };

  virtual ~PlayoutClock() = default;
  // The timeline has taken its newest pose; `source` answers with it.
  virtual void observe(const DancerTimeline& timeline, MotionSource& source) = 0;
  // Another dance: nothing is kept.
  virtual void restart() = 0;
  // The music that this house hears is elsewhere than it was said to be.
  virtual void on_music_jump() {}
  virtual void set_body(const Skeleton& /*skeleton*/) {}
  // What is asked for of it: come to gradually, so that no moment is left out.
  virtual void set(const FlowSetting& /*setting*/) {}

  // Once a picture. `shown`: the moment of the picture before; not set where there is none, or none
  // that this moment is bound to.
  virtual Choice choose(const DancerTimeline& timeline, MonoTime now, MonoTime shown) = 0;
  // With which lead to ask the source for it.
  virtual PredictionLead lead() const { return {}; }
  // Why this moment; out of rhythm there is nothing to say.
  virtual void explain(const DancerTimeline& /*timeline*/, MonoTime /*now*/,
                       Playout& /*playout*/) const {}
  // Musical time and the like of the pose that is shown.
  virtual void tag(MonoTime /*moment*/, Pose& /*pose*/) const {}
};

}  // namespace dance
