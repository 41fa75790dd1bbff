// PlayOut: how long after capture a moment should be shown, so that few poses come too late for it
// and none waits for longer than that is worth. Between two poses the stage interpolates, so what
// is needed for one is its way and the gap before it.
//
// Units/frames: durations from capture to arrival, of whatever clocks; all of them share the
//               offset.
// Ownership:    keeps the last 512 poses' (8 s at 60 Hz); never allocates.
// Threads:      none inside; one owner.
// Failure:      none.
// Source:       what was seen lately, as NetEq and other play-out buffers of voice take it; but the
//               least of delay and lateness together instead of a quantile: a line that stands
//               still for half a second now and then is not waited for.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

#include "core/base/time.h"

namespace dance {

class PlayOut {
 public:
  // `gap`: from the capture of the pose before to this one's.
  void add(Duration gap, Duration transit) {
    Duration& kept = needs_[count_ % kPoses];
    if (count_ >= kPoses) drop(kept);
    kept = gap + transit;
    keep(kept);
    ++count_;
    if (count_ % kPosesPerLook == 0 || count_ < kPosesPerLook) look();
  }
  Duration needed() const { return needed_; }
  void forget() { count_ = sorted_count_ = 0; }

 private:
  static constexpr std::size_t kPoses = 512;
  static constexpr std::size_t kPosesPerLook = 16;
  // What it is worth that one moment in a hundred less has to repeat a pose.
  static constexpr Duration kPerHundredth = Duration::ms(20);

  // sorted_ stays in order from pose to pose: a look costs what it reads.
  void drop(Duration need) {
    const auto end = sorted_.begin() + static_cast<std::ptrdiff_t>(sorted_count_);
    std::copy(std::lower_bound(sorted_.begin(), end, need) + 1, end,
              std::lower_bound(sorted_.begin(), end, need));
    --sorted_count_;
  }
  void keep(Duration need) {
    const auto end = sorted_.begin() + static_cast<std::ptrdiff_t>(sorted_count_);
    const auto at = std::upper_bound(sorted_.begin(), end, need);
    std::copy_backward(at, end, end + 1);
    *at = need;
    ++sorted_count_;
  }

  void look() {
    const std::size_t n = sorted_count_;
    needed_ = sorted_[n - 1];
    Duration least_cost = needed_;
    for (std::size_t late = 1; late < n; ++late) {
      const Duration delay = sorted_[n - 1 - late];
      const Duration lateness =
          kPerHundredth * static_cast<std::int64_t>(100 * late) / static_cast<std::int64_t>(n);
      if (sorted_[0] + lateness >= least_cost) break;  // no delay makes up for so many
      const Duration cost = delay + lateness;
      if (cost >= least_cost) continue;
      least_cost = cost;
      needed_ = delay;
    }
  }

  std::array<Duration, kPoses> needs_{}, sorted_{};
  std::size_t count_ = 0, sorted_count_ = 0;
  Duration needed_;
};

}  // namespace dance
