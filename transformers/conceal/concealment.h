// bridge: concealment of lapses. Where poses stay away for longer than a prediction reaches, the
// dance goes on with the dancer's own past (transformers/conceal/continuation.h) until they come
// back.
//
// Units/frames: moments are capture times, `now` is this house's clock. A lapse begins 250 ms after
//               the newest pose (60 where the newest pose is only repeated), when the line is
//               silent too.
// Ownership:    refers to the timeline while it runs; never allocates.
// Threads:      none inside; one owner. A frame costs some microseconds, the first of a lapse about
//               200.
// Failure:      a dancer who is not heard of is shown for no longer than Continuation::kLongest.
#pragma once

#include "transformers/conceal/continuation.h"
#include "transformers/timeline.h"

namespace dance {

class Concealment {
 public:
  // How much of the past there must be: 12 s at up to 120 Hz.
  static constexpr std::size_t kPoses = 1536;

  static bool is_lapse(const DancerTimeline& timeline, MonoTime moment, MonoTime now,
                       bool is_predicted);
  // From the newest pose, which stood until now.
  void begin(const DancerTimeline& timeline, MonoTime now);
  // From a prediction, of the moment `after` the newest pose: what is continued fades in and begins
  // where the prediction `meets` it.
  void begin_with(const DancerTimeline& timeline, MonoTime now, Duration after, const Pose& meets);
  void end();
  bool is_running() const { return continuation_.is_running(); }

  // `pose` is what is said of the moment without a continuation; mixes it in.
  void mix_into(MonoTime moment, Pose& pose);

 private:
  void mix(const Pose& predicted, const Pose& continued, float share, Pose& out);

  Continuation continuation_;
  Duration lapse_after_;   // how far after the newest pose is what was shown first of the lapse
  bool fades_in_ = false;  // from a prediction; not from a pose that stands
  // From the prediction to what is continued, as it was last mixed: beyond half a turn it goes on
  // the way that it went.
  BoneRotations turn_ = identity_rotations();
};

}  // namespace dance
