// Where one recording sounds in another: the delay between the two, piece by piece, by correlation.
//
// Units/frames: mono samples at 48 kHz; delays in milliseconds, of what `heard` has after `spoken`.
// Ownership:    plain values.
// Threads:      none inside.
// Failure:      pieces that are too quiet are left out; likeness is 0 where nothing fits.
#pragma once

#include <span>
#include <vector>

namespace dance {

struct SoundMatch {
  double at_s = 0.0;  // of the piece, in `spoken`
  double delay_ms = 0.0;
  double likeness = 0.0;  // 0 to 1
};

// Pieces of 400 ms, each looked for from `least_ms` to `most_ms` later.
std::vector<SoundMatch> match_sound(std::span<const float> spoken, std::span<const float> heard,
                                    double least_ms, double most_ms);

// Of the pieces that fit (likeness of 0.5 and more).
struct MatchFigures {
  std::size_t pieces = 0;
  std::size_t fitting = 0;
  double median_ms = 0.0;
  double p95_ms = 0.0;
};
MatchFigures figures_of(const std::vector<SoundMatch>& matches);

}  // namespace dance
