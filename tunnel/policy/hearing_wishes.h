// Whose voices the guests of one house want, as the programs that play them say it once a second:
// a voice is wanted that any of them wants.
//
// Units/frames: times of this house's clock.
// Ownership:    plain value; kMostGuests wishes. Those of more guests are not kept: they hear what
//               the others want.
// Threads:      none inside.
// Failure:      none.
#pragma once

#include <optional>

#include "core/base/time.h"
#include "core/bus/voice.h"
#include "tunnel/policy/hearing.h"
#include "tunnel/policy/held_wishes.h"

namespace dance {

class HearingWishes {
 public:
  static constexpr std::size_t kMostGuests = 16;
  static constexpr Duration kHolds = HeldWishes<GuestId, Hearing, kMostGuests>::kHolds;

  void hear(const HearingWish& wish, MonoTime now);
  // Removes the wishes that hold no longer; true where there were any.
  bool expire(MonoTime now) { return said_.expire(now); }
  // Some program of this house plays voices.
  bool is_any() const { return !said_.all().empty(); }
  // What `own` lets in of what is wanted; all of it while nobody says what is wanted.
  Hearing within(const Hearing& own) const;

 private:
  HeldWishes<GuestId, Hearing, kMostGuests> said_;
};

}  // namespace dance
