// StageLag: how much later than its capture a dancer's dance is shown: by that much a display's
// time and the moment of the dance differ. Delays only ever add to it, so the least of the last
// ones tells it best; it follows slowly, so that nobody is seen to hurry.
//
// Units/frames: lag = shown − captured; negative where a prediction is shown.
// Ownership:    plain value, no heap.
// Threads:      none inside.
// Failure:      none; a jump, as when a dancer's route or producer changes, is followed at once.
// Source:       minimum filter as in RFC 5905 (NTP), clock filter algorithm.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

#include "core/base/time.h"

namespace dance {

class StageLag {
 public:
  static constexpr std::size_t kWindow = 64;  // a second at 60 Hz
  static constexpr Duration kJump = Duration::ms(250);
  // The dance runs at most this part faster or slower while the lag changes.
  static constexpr std::int64_t kSlowness = 20;

  Duration add(Duration lag, MonoTime now) {
    if (count_ > 0 && (lag - last_ > kJump || last_ - lag > kJump)) count_ = 0;
    last_ = lag;
    window_[count_++ % kWindow] = lag;
    const auto end = window_.begin() + static_cast<std::ptrdiff_t>(std::min(count_, kWindow));
    const Duration least = *std::min_element(window_.begin(), end);
    const Duration most_change = count_ == 1 ? Duration::s(1'000'000) : (now - time_) / kSlowness;
    time_ = now;
    return smooth_ = std::clamp(least, smooth_ - most_change, smooth_ + most_change);
  }

 private:
  std::array<Duration, kWindow> window_{};
  std::size_t count_ = 0;
  Duration last_;
  Duration smooth_;
  MonoTime time_;
};

}  // namespace dance
