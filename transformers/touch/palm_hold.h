// PalmHold: whether two palms of two dancers hold each other, as they come and go on a stage whose
// poses jitter and are predicted. Being near begins a hold; only being away for a while ends it.
//
// Units/frames: metres; time of this house's clock.
// Ownership:    plain value.
// Threads:      none inside.
// Failure:      none; what is not finite ends nothing and begins nothing.
#pragma once

#include <algorithm>
#include <cmath>

#include "core/base/time.h"

namespace dance {

// Tuned by `dance touch eval` on takes 60/61 05 and 12 of CMU's salsa.
struct PalmHoldLimits {
  float begin_m = 0.10f;      // nearer than this begins
  float end_m = 0.20f;        // further apart than this …
  float far_m = 0.35f;        // further than this at once
  Duration patience = Duration::ms(150);  // … for so long ends
  Duration sure = Duration::ms(0);   // near for so long before it begins
};

class PalmHold {
 public:
  using Limits = PalmHoldLimits;
  static constexpr Duration kRamp = Duration::ms(150);

  void observe(float apart_m, MonoTime now, const Limits& limits = Limits()) {
    if (!std::isfinite(apart_m)) return;
    apart_m_ = apart_m;
    const Duration step = seen_.is_set() && now > seen_ ? now - seen_ : Duration();
    seen_ = now;
    if (is_held_) {
      if (apart_m <= limits.end_m) near_ = now;
      if (now - near_ > limits.patience || apart_m > limits.far_m) is_held_ = false;
    } else {
      if (apart_m > limits.begin_m || !near_.is_set()) near_ = now;
      if (apart_m <= limits.begin_m && now - near_ >= limits.sure) {
        is_held_ = true;
        near_ = since_ = now;
      }
    }
    const auto part = static_cast<float>(std::min(1.0, step.as_seconds() / kRamp.as_seconds()));
    ramp_ = std::clamp(ramp_ + (is_held_ ? part : -part), 0.0f, 1.0f);
  }
  void end() { *this = PalmHold(); }

  bool is_held() const { return is_held_; }
  MonoTime since() const { return since_; }
  float apart_m() const { return apart_m_; }
  // How far it has come, without a corner: 0 free … 1 held.
  float share() const { return ramp_ * ramp_ * (3.0f - 2.0f * ramp_); }

 private:
  bool is_held_ = false;
  float apart_m_ = 0.0f;
  float ramp_ = 0.0f;
  MonoTime seen_, near_, since_;
};

}  // namespace dance
