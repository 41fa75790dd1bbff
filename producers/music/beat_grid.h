// BeatGrid: maps beat numbers of a piece of music to seconds and back, and gives the local tempo.
//
// Units/frames: seconds from the begin of the music; beats count as core/base/beat.h says: 0 is the
//               first beat of the first bar, so that a grid that begins with the third of a bar of
//               four begins with beat 2.
// Ownership:    plain value.
// Threads:      none inside.
// Failure:      make() says which beat is wrong and why; it counts them from 1. Before the first
//               beat and after the last the tempo there continues.
#pragma once

#include <span>
#include <vector>

#include "core/base/result.h"

namespace dance {

struct GridBeat {
  double time_s = 0.0;
  int position = 0;  // in its bar, from 1; 0 = not known
};

class BeatGrid {
 public:
  static constexpr std::size_t kMostBeats = 100000;

  // At least two beats, in order, at tempi of 20 to 400 BPM.
  static Result<BeatGrid> make(std::span<const GridBeat> beats);

  std::size_t size() const { return times_s_.size(); }
  double first_beat() const { return first_beat_; }
  double last_beat() const { return first_beat_ + static_cast<double>(size() - 1); }
  // 0 where the bar is not known, or where the bars are of different lengths.
  int beats_per_bar() const { return beats_per_bar_; }

  double beat_at(double time_s) const;
  double time_of(double beat) const;  // seconds
  // Fitted to the beats around this one, so that jitter is no change of tempo. Where the tempo does
  // change, that of the interval before this beat, which is being heard.
  double tempo_bpm(double beat) const;

 private:
  std::size_t interval_of_beat(double beat) const;
  double period_around_s(std::size_t index) const;

  std::vector<double> times_s_;
  double first_beat_ = 0.0;
  int beats_per_bar_ = 0;
};

}  // namespace dance
