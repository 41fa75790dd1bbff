// BeatLine: the beats as one steady, counted line through what a BarPointer believes: small
// corrections are taken in softly, another line is taken only when it is clearly the likelier one,
// and each beat has the next number.
//
// Units/frames: seconds of one clock that the caller chooses.
// Ownership:    plain value.
// Threads:      none inside; one owner.
// Failure:      none; where nothing is near the line it runs on as it went.
#pragma once

#include <cstdint>

#include "producers/music/tracker/bar_pointer.h"

namespace dance {

class BeatLine {
 public:
  explicit BeatLine(double hop_s) : hop_s_(hop_s) {}

  // heard_s: when what the pointer heard last was to be heard. now_s: a beat is only predicted for
  // later.
  void follow(const BarPointer& pointer, double heard_s, double now_s);

  double next_s() const { return next_s_; }  // the next beat
  double period_s() const { return period_s_; }
  std::int64_t number() const { return number_; }  // of the next beat
  // Probability that the beats are where the line has them.
  double certainty() const { return certainty_; }

 private:
  // Counts what is over.
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
