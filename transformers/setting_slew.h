// SettingSlew: a setting that is changed while a dance is shown: comes to what is asked for at a
// bounded speed, so that what is shown has no jump.
//
// Units/frames: the setting's own, a second.
// Ownership:    plain value.
// Threads:      none inside; one owner.
// Failure:      a stage that stood still for long goes on as if it had been kLongestStep.
#pragma once

#include <algorithm>

#include "core/base/time.h"

namespace dance {

class SettingSlew {
 public:
  explicit SettingSlew(double value) : value_(value), wanted_(value) {}

  double value() const { return value_; }
  double wanted() const { return wanted_; }
  bool is_settled() const { return value_ == wanted_; }
  void want(double wanted) { wanted_ = wanted; }

  // Once a picture.
  double advance(MonoTime now, double most_a_second) {
    const Duration step = std::clamp(now - last_, Duration(), kLongestStep);
    last_ = now;
    const double most = most_a_second * step.as_seconds();
    value_ = std::clamp(wanted_, value_ - most, value_ + most);
    return value_;
  }

 private:
  static constexpr Duration kLongestStep = Duration::ms(50);
  double value_, wanted_;
  MonoTime last_;
};

}  // namespace dance
