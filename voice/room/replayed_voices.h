// ReplayedVoices: whether a voice on VOICE/capture is of a recording that plays again, and is to be
// heard. The others of this house who speak just now are not: they are in the same room. Each of
// their `dance voice` says so once a second on VOICE_STATE/capture, which is never replayed.
//
// Units/frames: times of this house's clock.
// Ownership:    plain value, no heap; remembers kMostGuests, those seen last.
// Threads:      none inside.
// Failure:      none. A guest of whom a state was lost for kHolds is played until the next.
#pragma once

#include <algorithm>

#include "core/base/fixed_list.h"
#include "core/base/guest_id.h"
#include "core/base/time.h"

namespace dance {

class ReplayedVoices {
 public:
  static constexpr std::size_t kMostGuests = 32;
  static constexpr Duration kHolds = Duration::s(3);
  // Only then the states of those who spoke before this program began have come.
  static constexpr Duration kSettles = Duration::ms(2500);

  // Of another guest: its own program speaks, here or in another house.
  void see_live(const GuestId& guest, MonoTime now) {
    for (Seen& seen : seen_) {
      if (seen.guest != guest) continue;
      seen.at = now;
      return;
    }
    if (seen_.try_push({guest, now})) return;
    *std::min_element(seen_.begin(), seen_.end(),
                      [](const Seen& a, const Seen& b) { return a.at < b.at; }) = {guest, now};
  }
  // Of another guest's capture; `begin` is when this program began to listen.
  bool is_replayed(const GuestId& guest, MonoTime begin, MonoTime now) const {
    return now - begin >= kSettles &&
           std::none_of(seen_.begin(), seen_.end(), [&](const Seen& seen) {
             return seen.guest == guest && now - seen.at < kHolds;
           });
  }

 private:
  struct Seen {
    GuestId guest;
    MonoTime at;
  };
  FixedList<Seen, kMostGuests> seen_;
};

}  // namespace dance
