// Beat: the position of the music as it is heard in this house. A music producer publishes it a few
// times a second; core/base/beat_clock.h makes musical time of it.
//
// Units/frames: beats count from the first beat of the first bar of the music; a beat is what
//               dancers count. Times are of the clock that clock_id names, and of what is *heard*:
//               a loudspeaker's latency is in them.
// Ownership:    plain value.
// Threads:      none inside.
// Failure:      is_valid() is false for values that are not finite, a tempo outside 20 to 400, a
//               bar of more than 16.
#pragma once

#include <cmath>
#include <cstdint>

#include "core/base/time.h"

namespace dance {

struct Beat {
  MonoTime time;  // when this was published
  std::uint64_t clock_id = 0;
  MonoTime beat_time;       // the next beat is heard then
  double beat = 0.0;        // its number; whole unless the beats are not numbered yet
  double tempo_bpm = 0.0;   // from there on
  int beats_per_bar = 0;    // 0: the bar is unknown, and `beat` has an arbitrary zero
  float confidence = 0.0f;  // 0 = uncertain … 1 = certain, as a beat grid is
  bool playing = false;     // false: the music is paused at `beat`

  // Position of the music at a time of the same clock.
  double beats_at(MonoTime t) const {
    return playing ? beat + (t - beat_time).as_seconds() * tempo_bpm / 60.0 : beat;
  }
};

constexpr double kLeastTempo_bpm = 20.0;
constexpr double kMostTempo_bpm = 400.0;
constexpr double kMostBeats = 1e7;

inline bool is_valid(const Beat& beat) {
  return std::abs(beat.beat) <= kMostBeats && beat.tempo_bpm >= kLeastTempo_bpm &&
         beat.tempo_bpm <= kMostTempo_bpm && beat.beats_per_bar >= 0 && beat.beats_per_bar <= 16 &&
         beat.confidence >= 0.0f && beat.confidence <= 1.0f;
}

}  // namespace dance
