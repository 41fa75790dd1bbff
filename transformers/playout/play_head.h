// PlayHead: which moment of the dance is on the stage: follows the wanted moment with a play rate
// that stays within what a body can do, and says when the way is too far to be walked.
//
// Units/frames: moments are capture times, `now` is the stage's clock; only differences of each are
//               used. Rate 1 is the dancer's own pace.
// Ownership:    plain value, no heap.
// Threads:      none inside.
// Failure:      a stage that stood still for long (0.25 s) is a jump, too.
// Source:       a first-order phase-locked loop with feed-forward.
#pragma once

#include <algorithm>
#include <cmath>

#include "core/base/time.h"

namespace dance {

constexpr double kSlowestPlay = 0.85;
constexpr double kFastestPlay = 1.18;

class PlayHead {
 public:
  bool is_set() const { return is_set_; }
  MonoTime moment() const { return moment_; }
  double rate() const { return rate_; }
  void reset() { is_set_ = false; }

  // Goes on by the rate to `now`: where the head stands if it does not jump. `pace` is the rate of
  // the wanted moment.
  MonoTime advance(MonoTime now, MonoTime wanted, double pace) {
    if (!is_set_ || now - time_ > kLongest || now < time_) {
      is_set_ = true;
      moment_ = wanted;
      rate_ = std::clamp(pace, kSlowestPlay, kFastestPlay);
    } else {
      const double dt_s = (now - time_).as_seconds();
      const double error_s = (wanted - moment_).as_seconds() - rate_ * dt_s;
      const double aim = std::clamp(pace + kPull_hz * error_s, kSlowestPlay, kFastestPlay);
      rate_ += std::clamp(aim - rate_, -kMostRateChange_hz * dt_s, kMostRateChange_hz * dt_s);
      moment_ += Duration::seconds(rate_ * dt_s);
    }
    time_ = now;
    return moment_;
  }
  void jump(MonoTime moment) { moment_ = moment; }

 private:
  static constexpr double kPull_hz = 1.5;
  static constexpr double kMostRateChange_hz = 6.0;
  static constexpr Duration kLongest = Duration::ms(250);

  MonoTime moment_, time_;
  double rate_ = 1.0;
  bool is_set_ = false;
};

}  // namespace dance
