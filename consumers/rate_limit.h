// RateLimit: a throttle: at most so many poses a second of each guest, evenly by the poses'
// capture times.
//
// Units/frames: hz; 0 lets everything through.
// Ownership:    remembers kMostGuests guests; never allocates.
// Threads:      none inside; one owner.
// Failure:      guests beyond kMostGuests are not let through; a clock that went back begins anew.
#pragma once

#include "core/base/fixed_list.h"
#include "core/base/guest_id.h"
#include "core/base/time.h"

namespace dance {

class RateLimit {
 public:
  static constexpr std::size_t kMostGuests = 64;

  explicit RateLimit(double hz) : period_(hz > 0.0 ? Duration::period_of_hz(hz) : Duration()) {}

  bool lets_through(const GuestId& guest, MonoTime captured) {
    if (period_ == Duration()) return true;
    for (Entry& entry : entries_) {
      if (!(entry.guest == guest)) continue;
      // Half a millisecond of tolerance: 60 Hz out of 120 Hz must not become 40 Hz because of
      // jitter.
      const Duration early = entry.next - captured;
      if (early > Duration::us(500) && early <= period_) return false;
      // On the grid where the poses keep up with it, so that the rate is met on average.
      const bool is_on_grid = early <= Duration::us(500) && -early < period_;
      entry.next = (is_on_grid ? entry.next : captured) + period_;
      return true;
    }
    return entries_.try_push({guest, captured + period_});
  }

 private:
  struct Entry {
    GuestId guest;
    MonoTime next;
  };
  Duration period_;
  FixedList<Entry, kMostGuests> entries_;
};

}  // namespace dance
