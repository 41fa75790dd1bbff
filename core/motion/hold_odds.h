// HoldOdds: at which odds a foot that is foreseen to stand is worth holding, of this dancer on this
// line: so low that of the moments in which feet were seen to stand nearly all had been foreseen
// with at least these. Where predictions are good that is high, and feet are held hardly longer
// than they stand.
//
// Units/frames: natural logarithms of odds, as core/motion/standing_odds.h; moments are capture
//               times.
// Ownership:    plain value, no heap.
// Threads:      none inside; one owner.
// Failure:      a moment that was not foreseen teaches nothing.
// Source:       stochastic approximation of a quantile (Robbins, Monro 1951).
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

#include "core/base/time.h"

namespace dance {

class HoldOdds {
 public:
  static constexpr float kLeast = -3.5f, kUsual = -1.7f, kMost = -0.5f;

  float value() const { return value_; }
  void clear() { *this = HoldOdds(); }

  // What was foreseen of the two feet at a moment.
  void foresee(MonoTime moment, const std::array<float, 2>& odds) {
    foreseen_[count_++ % foreseen_.size()] = {moment, odds};
  }

  // What was seen of them then.
  void see(MonoTime moment, const std::array<bool, 2>& stands) {
    const std::size_t n = std::min(count_, foreseen_.size());
    for (std::size_t back = 1; back <= n; ++back) {
      const Foreseen& then = foreseen_[(count_ - back) % foreseen_.size()];
      if (then.moment - moment > kNear || moment - then.moment > kNear) continue;
      for (std::size_t side = 0; side < 2; ++side)
        if (stands[side])
          value_ += kStep * (then.odds[side] >= value_ ? kMayBeMissed : kMayBeMissed - 1.0f);
      value_ = std::clamp(value_, kLeast, kMost);
      return;
    }
  }

 private:
  struct Foreseen {
    MonoTime moment;
    std::array<float, 2> odds{};
  };
  static constexpr Duration kNear = Duration::ms(9);
  static constexpr float kMayBeMissed = 0.05f;
  static constexpr float kStep = 0.1f;

  std::array<Foreseen, 64> foreseen_{};
  std::size_t count_ = 0;
  float value_ = kUsual;
};

}  // namespace dance
