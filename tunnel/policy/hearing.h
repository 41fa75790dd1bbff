// Whose voices a house wants: everybody's or nobody's, but for the guests who are excepted. What it
// does not want is not sent to it. One way to write it, on the command line (--hear) and in session
// files (hear).
//
// Units/frames: guests by name.
// Ownership:    plain values of fixed size.
// Threads:      none inside.
// Failure:      parse_hearing() names the word that is wrong and how it is written.
#pragma once

#include <span>
#include <string>

#include "tunnel/policy/interest.h"

namespace dance {

struct Hearing {
  bool others = true;  // who is not named
  FixedList<GuestId, kMaxInterestGuests> exceptions;

  bool hears(const GuestId& guest) const { return exceptions.contains(guest) != others; }
};

// Whom both want to hear. Of more names than there is room for, the last are as the others.
Hearing both_of(const Hearing& one, const Hearing& other);
// Whom one of the two wants to hear; of more names as above.
Hearing either_of(const Hearing& one, const Hearing& other);

// "bob=0", "default=0", "alice=1": each at most once.
Result<Hearing> parse_hearing(std::span<const std::string> words);

}  // namespace dance
