// StageLag: how much later than its capture a dancer's dance is shown: by that much a display's
// time and the moment of the dance differ. Delays only ever add to it, so the least of the last
// second tells it best; it follows slowly, so that nobody is seen to hurry.
//
// Units/frames: lag = shown − captured; negative where a prediction is shown.
// Ownership:    plain value, no heap.
// Threads:      none inside.
// Failure:      poses that came late together, as after a stall, change nothing: a jump up, as when
//               a dancer's route or producer changes, is followed when it has stayed for kStays. A
//               jump down is followed at once, as no delay makes poses early; so is one up by more
//               than kAnother, which is a recording that was paused or begins again.
// Source:       minimum filter as in RFC 5905 (NTP), clock filter algorithm.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "core/base/time.h"

namespace dance {

class StageLag {
 public:
  static constexpr Duration kWindow = Duration::s(1);
  // An engine predicts no further: a dancer who was followed slowly from there would rest.
  static constexpr Duration kJump = Duration::ms(100);
  static constexpr Duration kStays = Duration::ms(500);
  static constexpr Duration kAnother = Duration::s(2);
  // The dance runs at most this part faster or slower while the lag changes.
  static constexpr std::int64_t kSlowness = 20;

  Duration add(Duration lag, MonoTime now) {
    if (!time_.is_set() || time_ - now > kWindow || lag - smooth_ > kAnother)
      return restart(lag, now);
    // Times of two writers may be some milliseconds out of order.
    const MonoTime before = time_;
    time_ = std::max(time_, now);
    if (time_ - before > kStays) since_ = time_;
    keep(lag);
    if (lag - smooth_ <= kJump) {
      is_above_ = false;
    } else {
      if (!is_above_) above_since_ = time_;
      least_above_ = is_above_ ? std::min(least_above_, lag) : lag;
      is_above_ = true;
      if (time_ - above_since_ >= kStays) return restart(least_above_, time_);
    }
    const Duration least = least_kept();
    if (smooth_ - least > kJump) return smooth_ = least;
    const Duration most_change = std::min(time_ - before, kStays) / kSlowness;
    // Up only on the word of poses over some time: after a stall all are late for a moment.
    const bool may_grow = !is_above_ && time_ - since_ >= kStays;
    return smooth_ =
               std::clamp(least, smooth_ - most_change, may_grow ? smooth_ + most_change : smooth_);
  }

 private:
  // The least of each part of the window: any rate of poses fits.
  static constexpr std::int64_t kParts = 8;
  struct Part {
    std::int64_t number = -1;
    Duration least;
  };

  static std::int64_t number_of(MonoTime t) {
    return t.since_zero_ns() / (kWindow.count_ns() / kParts);
  }

  Duration restart(Duration lag, MonoTime now) {
    *this = StageLag();
    time_ = since_ = now;
    keep(lag);
    return smooth_ = lag;
  }
  void keep(Duration lag) {
    const std::int64_t number = number_of(time_);
    Part& part = parts_[static_cast<std::size_t>(number % kParts)];
    part.least = part.number == number ? std::min(part.least, lag) : lag;
    part.number = number;
  }
  Duration least_kept() const {
    const std::int64_t newest = number_of(time_);
    Duration least = parts_[static_cast<std::size_t>(newest % kParts)].least;
    for (const Part& part : parts_)
      if (part.number >= 0 && newest - part.number < kParts) least = std::min(least, part.least);
    return least;
  }

  std::array<Part, kParts> parts_{};
  MonoTime time_;   // of the newest
  MonoTime since_;  // poses have come without a pause
  Duration smooth_;
  bool is_above_ = false;  // the last poses all were later than smooth_ by a jump
  MonoTime above_since_;
  Duration least_above_;
};

}  // namespace dance
