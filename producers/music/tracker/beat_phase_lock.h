// BeatPhaseLock: locks a steady, counted sequence of beats to the probabilities of a BarPointer:
// small differences are corrected gradually, another phase or tempo is adopted only when it is
// clearly likelier, and beats are numbered without a gap.
//
// Units/frames: seconds of one clock that the caller chooses.
// Ownership:    plain value.
// Threads:      none inside; one owner.
// Failure:      none; where no beat is near, period and phase are kept.
#pragma once

#include <cstdint>

#include "producers/music/tracker/bar_pointer.h"

namespace dance {

class BeatPhaseLock {
 public:
  explicit BeatPhaseLock(double hop_s) : hop_s_(hop_s) {}

  // heard_s: the time of the pointer's newest strengths. now_s: only later beats are predicted.
  void follow(const BarPointer& pointer, double heard_s, double now_s);

  double next_s() const { return next_s_; }  // the next beat
  double period_s() const { return period_s_; }
  std::int64_t number() const { return number_; }  // of the next beat
  // Probability that the beats are where the lock has them.
  double certainty() const { return certainty_; }

 private:
  // Counts the beats that are over.
  void pass(double now_s);

  double hop_s_;
  double period_s_ = 0.5;
  double next_s_ = 0.0;
  double last_s_ = -1e9;  // the beat before that
  std::int64_t number_ = 0;
  double certainty_ = 0.0;
  bool begun_ = false;
};

}  // namespace dance
