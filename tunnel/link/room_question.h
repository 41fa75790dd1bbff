// Who is in rooms of a server, asked with a key that opens them, and without coming in: the same
// handshake as a link's, then a question for each room instead of a hello.
//
// Units/frames: none.
// Ownership:    plain values.
// Threads:      ask_who_is_there() waits, `patience` at most, or until `is_ended`: not for a thread
//               that draws.
// Failure:      what is not answered stays kUnanswered, as with a server that does not know the
//               question. Keys that do not agree, and certificates that are not trusted, are
//               kRefused.
#pragma once

#include <atomic>
#include <span>
#include <vector>

#include "core/net/address.h"
#include "tunnel/link/link_key.h"
#include "tunnel/wire/wire_room.h"

namespace dance {

struct RoomGuests {
  enum class State : std::uint8_t {
    kUnanswered,
    kNoKey,    // never of ask_who_is_there()
    kRefused,  // the key is there, and is not accepted, or cannot be used
    kNotHere,  // a server of a cluster does not know it
    kKnown,
  };
  State state = State::kUnanswered;
  std::size_t count = 0;
  FixedList<GuestId, wire::kMostNamesTold> names;
};

// In the order of the rooms. With an invitation's key nothing can be asked: it is good once.
std::vector<RoomGuests> ask_who_is_there(const Address& server, const LinkKey& key,
                                         std::span<const wire::RoomName> rooms, Duration patience,
                                         const std::atomic<bool>& is_ended);

}  // namespace dance
