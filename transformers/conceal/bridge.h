// bridge: what keeps a body a body, whatever arrives. Where poses stay away for longer than a
// prediction reaches, the dance goes on with the dancer's own past
// (transformers/conceal/continuation.h) until they come back; what is not yet known keeps joints in
// their limits and feet where they stand (core/motion/finish.h). Stands behind hold or predict.
//
// Units/frames: as transformers/transformer.h. A lapse begins 250 ms after the newest pose (60
//               where the station before only repeats it), when the line is silent too.
// Ownership:    keeps the last 12 s of poses (at up to 120 Hz, 650 kB); never allocates after
//               construction.
// Threads:      none inside; one owner. A frame costs some microseconds, the first of a lapse about
//               200.
// Failure:      a source that jumps back or changes its clock starts anew and is counted. Nobody is
//               shown for longer than Continuation::kLongest who is not heard of.
#pragma once

#include "core/base/beat_clock.h"
#include "core/motion/finish.h"
#include "transformers/conceal/continuation.h"
#include "transformers/transformer.h"

namespace dance {

struct BridgeOptions {
  Duration blend = Inertializer::kHalfLife;  // half-life of corrections
};

class Bridge : public Transformer {
 public:
  explicit Bridge(const BridgeOptions& options = {});

  void observe(const Pose& pose, MonoTime now) override;
  bool sample(MonoTime now, Pose& out) override;
  bool sample_at(MonoTime moment, MonoTime now, Pose& out) override;
  void hear(const Beat& beat, MonoTime now) override;
  void set_body(const Skeleton& skeleton) override;
  Duration patience() const override { return Continuation::kLongest; }

  bool is_continuing() const { return continuation_.is_running(); }

 private:
  bool is_lapse(MonoTime moment, MonoTime now, bool is_repeated) const;
  // Mixes what is continued into what the station before says of the moment.
  void carry_on(MonoTime moment, bool has_input, Pose& pose);
  Pose mix(const Pose& guess, const Pose& continued, float share);
  void end_lapse();
  Duration beat(MonoTime now) const;  // of the music here; 0: none

  PoseHistory history_;
  Continuation continuation_;
  Finish finish_;
  Skeleton skeleton_;
  BeatClock music_;
  MonoTime heard_;         // when the newest pose came
  Duration lapse_after_;   // how far after the newest pose is what was shown first of the lapse
  bool fades_in_ = false;  // from a prediction; not from a pose that stands
  bool comes_back_ = false;
  // From the guess to what is continued, as it was last mixed: beyond half a turn it goes on the
  // way that it went.
  BoneRotations turn_ = identity_rotations();
};

}  // namespace dance
