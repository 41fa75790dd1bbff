// At which level of the music told beats are: on the beats that dancers step on, at half or double
// of their tempo, or at their tempo but between them. People call the first three errors of the
// octave.
//
// Units/frames: seconds of one clock; shares of the time that told beats cover.
// Ownership:    plain values.
// Threads:      none inside.
// Failure:      where no two beats are told, all shares are 0.
#pragma once

#include <span>

namespace dance {

struct BeatLevel {
  double half = 0.0;
  double twice = 0.0;
  double off_beat = 0.0;

  double wrong() const { return half + twice + off_beat; }
};

// Both in order. Only what is told between from_s and to_s counts, and where the true beats reach.
BeatLevel level_of_beats(std::span<const double> truth_s, std::span<const double> told_s,
                         double from_s, double to_s);

}  // namespace dance
