// GuestNoise: numbers that vary with time and follow from a guest id and the time alone, so that
// every screen, every export and every repetition of a picture show the same.
//
// Threads: any.
#pragma once

#include <cstdint>

#include "core/base/fnv1a.h"
#include "core/base/guest_id.h"
#include "core/base/random.h"
#include "core/base/smooth_step.h"
#include "core/base/time.h"

namespace dance {

class GuestNoise {
 public:
  // Streams of one guest are independent; their number selects one.
  GuestNoise(const GuestId& guest, std::uint64_t stream)
      : seed_(fnv1a(guest.view()) + 0xd1342543de82ef95u * stream) {}

  struct Moment {
    std::int64_t period = 0;
    double s = 0.0;  // since the period began
  };
  static Moment moment_of(MonoTime time, std::int64_t period_ns) {
    const std::int64_t ns = time.since_zero_ns();
    const std::int64_t period = ns / period_ns - (ns % period_ns < 0 ? 1 : 0);
    return {period, 1e-9 * static_cast<double>(ns - period * period_ns)};
  }

  // Uniform in 0…1, one number for each period.
  double draw(std::int64_t period) const {
    return Random(seed_ + 0x9e3779b97f4a7c15u * static_cast<std::uint64_t>(period)).uniform();
  }
  // A smooth curve through the draws, in 0…1.
  float drift(MonoTime time, std::int64_t period_ns) const {
    const Moment at = moment_of(time, period_ns);
    const double from = draw(at.period), to = draw(at.period + 1);
    return static_cast<float>(from + (to - from) *
                                         smooth_step(1e9 * at.s / static_cast<double>(period_ns)));
  }

 private:
  std::uint64_t seed_;
};

}  // namespace dance
