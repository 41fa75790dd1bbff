// Lapses, judged: real dances whose poses stop for a while and come back. What a station shows
// meanwhile is held against what was danced, beside the frozen pose that is shown without one.
//
// Units/frames: errors in metres after removal of the hips' place and rotation; speeds in m/s;
//               frames at about 60 Hz.
// Ownership:    plain values.
// Threads:      none inside.
// Failure:      a take that is too short for any lapse adds nothing.
#pragma once

#include <vector>

#include "research/codec_takes.h"
#include "research/lapse/stage_subject.h"

namespace dance {

struct LapseFigures {
  double error_m = 0.0;        // mean over the lapse
  double activity = 0.0;       // mean joint speed while it lasts / the dancer's own meanwhile
  double body_activity = 0.0;  // the same relative to the hips
  double start_peak =
      0.0;  // fastest joint in its first 200 ms / the dancer's own fastest about there
  double wrap_peak = 0.0;       // after that
  double return_peak = 0.0;     // in the 500 ms after it
  double root_drift_m = 0.0;    // furthest that the hips go from where they were
  double return_error_m = 0.0;  // 300 ms after it: how far still from what is danced
  int trials = 0;
};

struct LapseOptions {
  Duration warm_up = Duration::s(6);
  Duration every = Duration::ms(1300);
};

// All lapses of one length over all takes. Peaks are the largest of all trials.
LapseFigures evaluate_lapse(const std::vector<CodecTake>& takes, const MakeSubject& make,
                            Duration length, const LapseOptions& options = {});

}  // namespace dance
