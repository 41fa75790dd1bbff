// The guests of a session: who dances in its house, and whether those who speak and feel are among
// them, as the file says or other guests stand in.
//
// Units/frames: none.
// Ownership:    plain values.
// Threads:      none inside.
// Failure:      what is wrong is told with those who are there.
#pragma once

#include "house/session.h"

namespace dance {

// Why this guest would not be heard, and would feel nothing; "" where nothing is wrong. A house
// without dancers may name anybody: its producers may run beside it.
std::string trouble_of_speaking(const HouseConfig& session, const GuestId& guest);
std::string trouble_of_feeling(const HouseConfig& session, const GuestId& guest);

// These dance instead of those of the file; the first speaks where the file names no speaker.
void replace_guests(HouseConfig& session, std::vector<GuestId> guests);
// "Ana López" for the first guest, or "bob=Bob" for the guest of that id.
Result<void> set_shown_name(HouseConfig& session, std::string_view text);
// Removes all that dances, speaks or feels; the house enters the room with its guest's key.
void only_watch(HouseConfig& session);
// [voice] and [[haptics]] of a session whose guests or producers are not the file's any more.
Result<void> check_guests(const HouseConfig& session);

}  // namespace dance
