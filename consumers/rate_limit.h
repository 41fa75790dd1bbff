// RateLimit: a throttle: at most so many poses a second of each guest, evenly by the poses'
// capture times.
//
// Units/frames: hz, as check_rate() wants it; 0 lets everything through.
// Ownership:    remembers kMostGuests guests; never allocates.
// Threads:      none inside; one owner.
// Failure:      guests beyond kMostGuests are not let through; a clock that went back begins anew.
#pragma once

#include "core/base/fixed_list.h"
#include "core/base/guest_id.h"
#include "core/base/result.h"
#include "core/base/time.h"

namespace dance {

constexpr double kSlowestRate_hz = 0.001;  // its period still fits a Duration
constexpr double kFastestRate_hz = 1000.0;

// Of options, those of a program's line and of a session: a slower rate than this has no period.
inline Result<void> check_rate(double hz) {
  if (hz == 0.0 || (hz >= kSlowestRate_hz && hz <= kFastestRate_hz)) return {};
  return fail("the rate is 0, or from 0.001 to 1000 a second");
}

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
