// Song: maps beats to seconds in a piece of music that may loop.
//
// Units/frames: song seconds are those of the chosen speed, and count on from round to round; beats
//               too, by as many whole bars as a round holds, so that the first beat of each round
//               is the first of a bar.
// Ownership:    plain value.
// Threads:      none inside.
// Failure:      none; beyond the ends it is as producers/music/beat_grid.h says.
#pragma once

#include <optional>

#include "producers/music/beat_grid.h"

namespace dance {

class Song {
 public:
  Song(BeatGrid grid, double length_s, bool loops);

  double length_s() const { return length_s_ / speed_; }
  // 1 = as in the file; more is faster. Beats keep their numbers.
  double speed() const { return speed_; }
  void set_speed(double speed) { speed_ = speed; }
  bool loops() const { return loops_; }
  void set_loops(bool loops) { loops_ = loops; }
  bool is_over(double song_s) const { return !loops_ && song_s >= length_s(); }
  int beats_per_bar() const { return grid_.beats_per_bar(); }
  const BeatGrid& grid() const { return grid_; }

  double beat_at(double song_s) const;
  double time_of(double beat) const;  // song seconds
  double tempo_bpm(double song_s) const;

  struct NextBeat {
    double beat = 0.0;  // whole
    double song_s = 0.0;
    double tempo_bpm = 0.0;
  };
  // The first one after that second.
  NextBeat next_beat(double song_s) const;

 private:
  double round_of(double file_s) const;

  BeatGrid grid_;
  double length_s_;  // at speed 1
  double speed_ = 1.0;
  bool loops_;
  double round_beats_;
};

}  // namespace dance
