// The live clock: the dancer as they are now, or nearer to it than what has arrived: takes the
// line's delay back, or the part of it that it is told.
//
// Units/frames: capture times and `now` are of one clock, as the tunnel maps them. `lead` is the
//               part of the delay that is taken back, 0 to 1.5.
// Ownership:    plain values; never allocates.
// Threads:      none inside; one owner.
// Failure:      poses whose clock is not this house's are shown as they come, without a lead.
#pragma once

#include "transformers/playout/least_transit.h"
#include "transformers/playout/playout_clock.h"
#include "transformers/setting_slew.h"

namespace dance {

class LiveClock : public PlayoutClock {
 public:
  explicit LiveClock(double lead = 1.0) : lead_(lead) {}

  void observe(const DancerTimeline& timeline, MotionSource& source) override;
  void restart() override { least_transit_.forget(); }
  Choice choose(const DancerTimeline& timeline, MonoTime now, MonoTime shown) override;
  void set(const FlowSetting& setting) override;

 private:
  SettingSlew lead_;
  LeastTransit least_transit_;
  Duration transit_;  // followed slowly
};

}  // namespace dance
