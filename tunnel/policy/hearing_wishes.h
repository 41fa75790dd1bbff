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

namespace dance {

class HearingWishes {
 public:
  static constexpr std::size_t kMostGuests = 16;
  // It is said once a second; a program that was silent so long has ended.
  static constexpr Duration kHolds = Duration::s(5);

  void hear(const HearingWish& wish, MonoTime now);
  // Removes the wishes that hold no longer; true where there were any.
  bool expire(MonoTime now);
  // Some program of this house plays voices.
  bool is_any() const { return !said_.empty(); }
  // What `own` lets in of what is wanted; all of it while nobody says what is wanted.
  Hearing within(const Hearing& own) const;

 private:
  struct Said {
    GuestId guest;
    Hearing hearing;
    MonoTime at;
  };
  FixedList<Said, kMostGuests> said_;
};

}  // namespace dance
