// BeatClock: musical time as a clock that can be read at any moment. Received beats set it; it
// extrapolates between them, slews small corrections, and reports when its last beat is too old.
//
// Units/frames: positions in beats as core/base/beat.h counts them; times of one clock.
// Ownership:    plain value, no heap.
// Threads:      none inside.
// Failure:      is_known() is false before the first beat, while the music is paused, and 3 s after
//               the last beat.
#pragma once

#include <algorithm>
#include <cmath>

#include "core/base/beat.h"

namespace dance {

class BeatClock {
 public:
  static constexpr Duration kTimeout = Duration::s(3);

  // Returns true when the music jumped: another song, a seek, the first beat.
  bool hear(const Beat& beat) {
    const bool was_known = is_known(beat.time);
    const double before = was_known ? position(beat.time) : 0.0;
    beat_ = beat;
    heard_ = true;
    correction_ = 0.0;
    correction_time_ = beat.time;
    if (!was_known || !beat.playing) return !was_known;
    const double error = before - beat.beats_at(beat.time);
    if (std::abs(error) > kJump_beats) return true;
    correction_ = error;
    return false;
  }

  bool is_known(MonoTime t) const { return heard_ && beat_.playing && age_is_fine(t - beat_.time); }
  double position(MonoTime t) const { return beat_.beats_at(t) + correction_at(t); }
  // When the music is, or was, at `beats`.
  MonoTime time_of(double beats) const {
    // The correction changes more slowly than the music advances, so this iteration converges.
    MonoTime t = line_time_of(beats);
    for (int i = 0; i < 16; ++i) t = line_time_of(beats - correction_at(t));
    return t;
  }
  double beats_per_second() const { return beat_.tempo_bpm / 60.0; }
  Duration period() const { return Duration::seconds(60.0 / beat_.tempo_bpm); }
  int beats_per_bar() const { return beat_.beats_per_bar; }
  float confidence() const { return beat_.confidence; }
  const Beat& newest() const { return beat_; }

  // Shows an archive all that the clock remembers, to be kept and set again.
  template <class Archive>
  void carry(Archive& archive) {
    archive(beat_.time), archive(beat_.clock_id), archive(beat_.beat_time), archive(beat_.beat);
    archive(beat_.tempo_bpm), archive(beat_.beats_per_bar), archive(beat_.confidence);
    archive(beat_.playing), archive(heard_), archive(correction_), archive(correction_time_);
    if (heard_ && !is_valid(beat_)) archive.refuse();
  }

 private:
  // A larger difference is another place of the music. A smaller one is slewed so that time stays
  // monotonic at 50 BPM too.
  static constexpr double kJump_beats = 0.25;
  static constexpr double kTakenIn_s = 0.3;

  // A beat published in the future is as invalid as an old one.
  static bool age_is_fine(Duration age) { return age < kTimeout && age > -kTimeout; }
  MonoTime line_time_of(double beats) const {
    return beat_.beat_time + Duration::seconds((beats - beat_.beat) * 60.0 / beat_.tempo_bpm);
  }
  double correction_at(MonoTime t) const {
    const double age_s = std::max(0.0, (t - correction_time_).as_seconds());
    return correction_ * std::exp(-age_s / kTakenIn_s);
  }

  Beat beat_;
  bool heard_ = false;
  double correction_ = 0.0;
  MonoTime correction_time_;
};

}  // namespace dance
