// OneEuro: the 1€ filter: a low pass whose cutoff rises with the speed of its input.
//
// Units/frames: what the caller gives; hertz.
// Ownership:    plain value.
// Threads:      none inside.
// Failure:      none; the first number after reset() comes back as it is.
// Source:       Casiez, Roussel, Vogel: 1€ filter, CHI 2012.
#pragma once

#include <cmath>
#include <numbers>

namespace dance {

struct OneEuroSetting {
  double min_cutoff_hz = 1.0;
  double beta = 0.0;
  double speed_cutoff_hz = 1.0;
};

class OneEuro {
 public:
  // `hz`: one over the time since the last number. `scale` makes speeds of large and small things
  // alike.
  float next(float value, double hz, double scale, const OneEuroSetting& setting) {
    if (!has_last_) {
      has_last_ = true;
      last_ = value;
      smooth_ = value;
      speed_ = 0.0;
      return value;
    }
    const double speed = (value - last_) * scale * hz;
    last_ = value;
    speed_ += weight(setting.speed_cutoff_hz, hz) * (speed - speed_);
    const double cutoff_hz = setting.min_cutoff_hz + setting.beta * std::abs(speed_);
    smooth_ += weight(cutoff_hz, hz) * (value - smooth_);
    return static_cast<float>(smooth_);
  }
  void reset() { has_last_ = false; }

 private:
  // w = 1 / (1 + hz / (2π·cutoff))
  static double weight(double cutoff_hz, double hz) {
    return 1.0 / (1.0 + hz / (2.0 * std::numbers::pi * cutoff_hz));
  }

  bool has_last_ = false;
  double last_ = 0.0;
  double smooth_ = 0.0;
  double speed_ = 0.0;
};

}  // namespace dance
