// How well told beats fit true ones, and what a listener who can only hear was told in time: a beat
// counts with the last time that was predicted for it while it was still ahead by a hop or more.
//
// Units/frames: seconds of one clock.
// Ownership:    plain values.
// Threads:      none inside.
// Failure:      no beats at all have an F measure of 0.
#pragma once

#include <span>
#include <vector>

#include "core/base/beat.h"

namespace dance {

constexpr double kBeatTolerance_s = 0.07;

struct BeatScore {
  int truth = 0;
  int told = 0;
  int hits = 0;
  // Of the hits: told minus true.
  double mean_error_s = 0.0;
  double sd_error_s = 0.0;

  double f_measure() const {
    return truth + told > 0 ? 2.0 * hits / static_cast<double>(truth + told) : 0.0;
  }
};

// Both in order; each beat is matched at most once. Only what lies between from_s and to_s counts.
BeatScore score_beats(std::span<const double> truth_s, std::span<const double> told_s,
                      double from_s, double to_s);

// Fed with what a tracker says after each hop.
class PredictedBeats {
 public:
  explicit PredictedBeats(double hop_s) : hop_s_(hop_s) {}
  void hear(const Beat& beat);
  const std::vector<double>& times_s() const { return times_s_; }

 private:
  double hop_s_;
  bool begun_ = false;
  double number_ = 0.0;
  double promised_s_ = 0.0;
  bool promised_ = false;
  std::vector<double> times_s_;
};

}  // namespace dance
