// Of whom the windows of one house want no poses, as each says it once a second: a guest is left
// out whom all of them hide. One that shows everybody says so too, and keeps everybody coming.
//
// Units/frames: times of this house's clock.
// Ownership:    plain value; kMostViewers wishes. While there are more windows than that nobody is
//               left out.
// Threads:      none inside.
// Failure:      none.
#pragma once

#include "core/base/time.h"
#include "core/bus/house_messages.h"
#include "tunnel/policy/hearing.h"
#include "tunnel/policy/held_wishes.h"
#include "tunnel/policy/interest.h"

namespace dance {

class InterestWishes {
 public:
  static constexpr std::size_t kMostViewers = 8;
  using Hidden = FixedList<GuestId, InterestWish::kMostHidden>;
  static constexpr Duration kHolds = HeldWishes<std::uint64_t, Hidden, kMostViewers>::kHolds;
  // Servers send no voice of a guest of whom no pose is wanted: of one who is heard so few come.
  static constexpr std::uint8_t kFewest = 255;

  void hear(const InterestWish& wish, MonoTime now);
  // Removes the wishes that hold no longer; true where there were any.
  bool expire(MonoTime now);
  bool is_hidden(const GuestId& guest) const;
  // What is left of `own`; `voices`: what this house plays of the others' voices.
  Interest within(const Interest& own, const Hearing& voices) const;

 private:
  HeldWishes<std::uint64_t, Hidden, kMostViewers> said_;
  MonoTime crowded_;  // one was heard for whom there is no place
};

}  // namespace dance
