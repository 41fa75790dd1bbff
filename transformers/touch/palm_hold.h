// PalmHold: whether two palms of two dancers hold each other, as they come and go on a stage whose
// poses jitter and are predicted. Being near begins a hold; only being away for a while ends it.
//
// Units/frames: metres; time of this house's clock.
// Ownership:    plain value.
// Threads:      none inside.
// Failure:      none; what is not finite ends nothing and begins nothing.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "core/base/smooth_step.h"
#include "core/base/time.h"

namespace dance {

// By `dance touch eval` on the salsa of CMU's subjects 60 and 61, who are one couple: what --choose
// finds for each dance on the others, but for ends that let arms reach for less long.
struct PalmHoldLimits {
  float begin_m = 0.075f;                // nearer than this begins
  float again_m = 0.076f;                // and nearer than this, of palms that held each other …
  Duration lately = Duration::ms(1500);  // … so lately
  float early_m = 0.09f;                 // and nearer than this …
  float soon_m = 0.04f;                  // … where the palms come so near …
  Duration look = Duration::ms(120);     // … within so long, as they move
  float end_m = 0.23f;                   // further apart than this …
  Duration release_delay = Duration::ms(260);  // … for so long ends
  float far_m = 0.35f;                         // further than this at once
};

class PalmHold {
 public:
  using Limits = PalmHoldLimits;
  static constexpr Duration kRamp = Duration::ms(150);

  // `apart`: from one palm to the other, in a frame that both move in.
  void observe(const Eigen::Vector3f& apart, MonoTime now, const Limits& limits = Limits()) {
    if (!apart.allFinite()) return;
    const Duration step = seen_.is_set() && now > seen_ ? now - seen_ : Duration();
    if (step >= kGap) {
      speed_m_s_.setZero();
    } else if (step > Duration()) {
      const Eigen::Vector3f newest = (apart - apart_) / static_cast<float>(step.as_seconds());
      const double keep = std::exp2(-step.as_seconds() / kHalfLife.as_seconds());
      speed_m_s_ += static_cast<float>(1.0 - keep) * (newest - speed_m_s_);
    }
    apart_ = apart;
    const float apart_m = apart.norm();
    seen_ = now;
    if (is_held_) {
      if (apart_m <= limits.end_m) near_ = now;
      if (now - near_ > limits.release_delay || apart_m > limits.far_m) is_held_ = false;
    } else {
      const bool was_held = near_.is_set() && now - near_ < limits.lately;
      const bool begins = apart_m <= (was_held ? limits.again_m : limits.begin_m) ||
                          (apart_m <= limits.early_m && nearest_m(limits.look) <= limits.soon_m);
      if (begins) {
        is_held_ = true;
        near_ = now;
      }
    }
    const auto part = static_cast<float>(std::min(1.0, step.as_seconds() / kRamp.as_seconds()));
    ramp_ = std::clamp(ramp_ + (is_held_ ? part : -part), 0.0f, 1.0f);
  }
  void end() { *this = PalmHold(); }

  bool is_held() const { return is_held_; }
  // How far it has come, without a corner: 0 free … 1 held.
  float share() const { return smooth_step(ramp_); }

 private:
  static constexpr Duration kHalfLife = Duration::ms(20);  // of the speed
  static constexpr Duration kGap = Duration::ms(250);

  // The least distance from now on, if the palms go on as they move.
  float nearest_m(Duration look) const {
    const float square = std::max(speed_m_s_.squaredNorm(), 1e-6f);
    const float at_s =
        std::clamp(-apart_.dot(speed_m_s_) / square, 0.0f, static_cast<float>(look.as_seconds()));
    return (apart_ + at_s * speed_m_s_).norm();
  }

  bool is_held_ = false;
  Eigen::Vector3f apart_ = Eigen::Vector3f::Zero();
  Eigen::Vector3f speed_m_s_ = Eigen::Vector3f::Zero();
  float ramp_ = 0.0f;
  MonoTime seen_, near_;
};

}  // namespace dance
