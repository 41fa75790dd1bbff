// hold: the play-out buffer's clock. Shows each moment of the dance a constant time after it
// happened, so that the jitter of the line is gone: constant = the least delay that the line has
// shown lately + the window. It never goes back. Without a window it finds the least that is
// enough, line by line and guest by guest (transformers/playout/play_out.h).
//
// Units/frames: the window is a Duration of 0 to 2 s; found by itself, it is 250 ms at most.
//               Capture times may be of any clock: the least delay absorbs the offset, so a log
//               replayed with its old stamps plays as well as a live dancer.
// Ownership:    plain values; never allocates.
// Threads:      none inside; one owner.
// Failure:      none.
// Source:       least-delay offset filter as in NTP (RFC 5905, clock filter); delay changed
//               gradually as play-out buffers of voice do.
#pragma once

#include <optional>

#include "transformers/playout/least_transit.h"
#include "transformers/playout/play_out.h"
#include "transformers/playout/playout_clock.h"

namespace dance {

class HoldClock : public PlayoutClock {
 public:
  // Nothing: as short as the line allows.
  explicit HoldClock(std::optional<Duration> window = std::nullopt) : window_(window) {}

  void observe(const DancerTimeline& timeline, MotionSource& source) override;
  void restart() override;
  Choice choose(const DancerTimeline& timeline, MonoTime now, MonoTime shown) override;

  void set(const FlowSetting& setting) override;

  // From capture to display, as it is now; of another clock it includes the clocks' offset.
  Duration delay() const { return delay_; }

 private:
  Duration target() const;
  void follow_target(MonoTime now);

  std::optional<Duration> window_;
  PlayOut play_out_;
  LeastTransit transit_;
  Duration delay_;
  MonoTime begin_, delay_set_;
  bool has_delay_ = false, is_set_live_ = false;
};

}  // namespace dance
