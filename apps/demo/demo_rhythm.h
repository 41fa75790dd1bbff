// How well a demo's stage keeps the remote dancer on the beat, measured on what was shown: the same
// dance as its poses came and as the routes showed it, beside the dance as it was danced, sampled
// as a display would.
//
// Units/frames: ms, positive is behind the beat; beats of the music that house A hears; sway in cm,
//               to the dancer's left.
// Ownership:    plain values.
// Threads:      none inside.
// Failure:      a dance of less than some seconds, or without music, gives no figures.
#pragma once

#include <optional>
#include <vector>

#include "apps/demo/demo_trace.h"

namespace dance {

struct StageFigures {
  double phase_mean_ms = 0.0,
         phase_sd_ms = 0.0;       // of the four-count in the motion (testing/motion/beat_phase.h)
  double content_delay_ms = 0.0;  // from capture to the picture
  double jerk_ratio = 0.0;        // against the dance as it was danced
  double error_mm = 0.0;  // of joints, against the dance at the moment of the picture, hips on hips
};

struct DemoRhythm {
  StageFigures raw, shown;
  double tempo_bpm = 0.0;
  double seconds = 0.0;  // measured
};

std::optional<DemoRhythm> measure_rhythm(const DemoTrace& trace);

// Six beats one after the other, late in the dance, from the first count of a bar on where that can
// be; nullopt without music.
std::vector<double> beats_to_show(const DemoTrace& trace);

// The hips' path over the feet, which shows the beat in salsa.
struct SwayLine {
  std::vector<double> beats, sway_cm;
};
struct SwayLines {
  SwayLine here;    // who dances in house A, on the music there
  SwayLine danced;  // the remote dancer, laid onto the same music by the own musical time
  SwayLine raw, shown;
  double tempo_bpm = 0.0;
};
// Of the last `span_beats` that begin with a bar.
std::optional<SwayLines> sway_lines(const DemoTrace& trace, double span_beats);

}  // namespace dance
