// hold: the play-out buffer. Shows each moment of the dance a constant time after it happened, so
// that the jitter of the line is gone: constant = the least delay that the line has shown lately +
// the window. Between poses it interpolates; where the next pose is late it repeats the last; it
// never goes back. Without a window it finds the least that is enough, line by line and guest by
// guest (transformers/playout/play_out.h).
//
// Units/frames: the window is a Duration of 0 to 2 s; found by itself, it is 250 ms at most.
//               Capture times may be of any clock: the least delay absorbs the offset, so a log
//               replayed with its old stamps plays as well as a live dancer.
// Ownership:    keeps the last 256 poses; never allocates after construction.
// Threads:      none inside; one owner.
// Failure:      a pose that is not newer is refused and counted; a source that jumps back by more
//               than a second, or changes its clock, starts anew and is counted.
// Source:       least-delay offset filter as in NTP (RFC 5905, clock filter); delay changed
//               gradually as play-out buffers of voice do.
#pragma once

#include <optional>

#include "core/pose/history.h"
#include "transformers/playout/least_transit.h"
#include "transformers/playout/play_out.h"
#include "transformers/transformer.h"

namespace dance {

class Hold : public Transformer {
 public:
  // Nothing: as short as the line lets it.
  explicit Hold(std::optional<Duration> window = std::nullopt);

  void observe(const Pose& pose, MonoTime now) override;
  bool sample(MonoTime now, Pose& out) override;
  MonoTime moment(MonoTime now) override;
  bool sample_at(MonoTime moment, MonoTime now, Pose& out) override;

  // From capture to display, as it is now; of another clock it includes the clocks' offset.
  Duration delay() const { return delay_; }

 private:
  Duration target() const;
  void follow_target(MonoTime now);

  std::optional<Duration> window_;
  PlayOut play_out_;
  PoseHistory history_;
  LeastTransit transit_;
  Duration delay_;
  MonoTime begin_, delay_set_;
  MonoTime shown_;  // the newest moment that was shown
  bool has_delay_ = false;
};

}  // namespace dance
