// The beats that a recorded dance was danced to, found from the feet over the whole take: a steady
// tempo and where a beat falls. For evaluations, which lay a take onto music; what runs live is
// transformers/tempo/period.
//
// Units/frames: seconds from the take's begin; a bar is four beats.
// Ownership:    plain values.
// Threads:      none inside.
// Failure:      a take in which nobody steps gets a tempo all the same; `strength` says what it is
//               worth.
#pragma once

#include "testing/motion/motion_measures.h"

namespace dance {

struct TakeGrid {
  double tempo_bpm = 0.0;
  double first_beat_s = 0.0;  // the first at or after the take's begin
  double strength = 0.0;      // share of the feet's speed that goes with beats, 0 to 1

  double beats_at(double t_s) const { return (t_s - first_beat_s) * tempo_bpm / 60.0; }
  double time_of(double beats) const { return first_beat_s + beats * 60.0 / tempo_bpm; }
};

TakeGrid find_take_grid(const JointTrack& track);

}  // namespace dance
