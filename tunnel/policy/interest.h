// Which guests a house wants to hear, and how often: a divider for each, and one for all others.
// Guests named with 1 come before all others where the line does not bear everything
// (tunnel/server/signals/server_pace.h).
// One way to write it, on the command line (--want) and in session files (want);
// tunnel/policy/pose_share.h says what comes of it.
//
// Units/frames: a divider: 0 = nothing of this guest, 1 = every pose, n = at most every n-th.
// Ownership:    plain values of fixed size, no allocation; parse_interest() is not for the pose
//               path.
// Threads:      none inside.
// Failure:      parse_interest() names the word that is wrong and how it is written, not where it
//               stood.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "core/base/fixed_list.h"
#include "core/base/guest_id.h"
#include "core/base/result.h"

namespace dance {

// As many as a room may have.
constexpr std::size_t kMaxInterestGuests = 128;

// By name, as a house says it.
struct Interest {
  struct One {
    GuestId guest;
    std::uint8_t divider = 1;
    bool operator==(const One&) const = default;
  };
  std::uint8_t others = 1;  // who is not named
  FixedList<One, kMaxInterestGuests> guests;

  bool names(const GuestId& guest) const {
    for (const One& one : guests)
      if (one.guest == guest) return true;
    return false;
  }
  std::uint8_t divider_of(const GuestId& guest) const {
    for (const One& one : guests)
      if (one.guest == guest) return one.divider;
    return others;
  }
};

// "alice=1", "bob=0", "default=2": each at most once.
Result<Interest> parse_interest(std::span<const std::string> words);

}  // namespace dance
