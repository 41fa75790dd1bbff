// DemoTrace: what a demo's comparison is measured on: the remote dancer of house A as danced in
// house B, as the poses came, and as the stage showed them; and the musical time of house A
// meanwhile.
//
// Units/frames: both houses share this machine's clock; beats of the music in house A, but for the
//               tags of poses.
// Ownership:    keeps the last kKept of each, copied. Refers to the buses, which must outlive it.
// Threads:      none inside; runs in the poller's thread.
// Failure:      what was never heard is an empty list.
#pragma once

#include <vector>

#include "core/bus/signal_port.h"
#include "core/pose/music_here.h"

namespace dance {

struct TracedPose {
  MonoTime at;  // when it was staged; of captures, when they were
  Pose pose;
};

struct TracedBeats {
  MonoTime at;
  double beats = 0.0;
  double beats_per_second = 0.0;
};

class DemoTrace {
 public:
  static constexpr std::size_t kKept = 4096;  // 68 s at 60 Hz

  // `here` dances in house A, `remote` in house B.
  DemoTrace(SignalPort& bus_a, SignalPort& bus_b, const GuestId& here, const GuestId& remote);

  // The dance is over.
  void stop() { is_over_ = true; }

  const GuestId& here() const { return here_; }
  const GuestId& remote() const { return remote_; }
  const std::vector<TracedPose>& of_here() const { return captured_here_; }
  const std::vector<TracedPose>& danced() const { return danced_; }
  const std::vector<TracedPose>& raw() const { return raw_; }
  const std::vector<TracedPose>& shown() const { return shown_; }
  const std::vector<TracedBeats>& music() const { return music_; }
  const Skeleton& body_of_here() const { return body_of_here_; }
  const Skeleton& body_of_remote() const { return body_of_remote_; }

 private:
  void keep(std::vector<TracedPose>& list, const Pose& pose, MonoTime at);

  GuestId here_, remote_;
  bool is_over_ = false;
  MusicHere heard_;
  std::vector<TracedPose> captured_here_, danced_, raw_, shown_;
  std::vector<TracedBeats> music_;
  Skeleton body_of_here_ = average_skeleton(), body_of_remote_ = average_skeleton();
};

}  // namespace dance
