// Who is in a room, asked by a holder of a key that opens it, who need not come in for it; built
// and parsed; docs/wire-format.md says it byte by byte. A peer that does not know these types drops
// them, as it drops any that it does not know.
//
// Units/frames: none.
// Ownership:    plain values; nothing here allocates.
// Threads:      none inside.
// Failure:      as in tunnel/wire/wire.h.
#pragma once

#include "tunnel/wire/wire.h"

namespace dance::wire {

// Of both, behind the type: another form is another meaning, and not parsed.
constexpr std::uint8_t kRoomForm = 1;
// As many names are told; of more guests their number.
constexpr std::size_t kMostNamesTold = 32;

struct RoomQuestion {
  std::uint32_t number = 0;  // not 0; the answer has the same
  RoomName room;
};

enum class RoomResult : std::uint8_t {
  kKnown = 1,
  kNotAllowed = 2,  // the key does not open the room, or a host has removed its guests
  kNotHere = 3,     // a server of a cluster, which does not know all who are in the room
};
struct RoomAnswer {
  std::uint32_t number = 0;
  RoomResult result = RoomResult::kKnown;
  std::uint8_t count = 0;  // guests in the room
  FixedList<GuestId, kMostNamesTold> names;
};

// Whole datagrams, opening included.
std::size_t build(const RoomQuestion& question, std::span<std::uint8_t> out);
std::size_t build(const RoomAnswer& answer, std::span<std::uint8_t> out);
std::optional<RoomQuestion> parse_room_question(Bytes body);
std::optional<RoomAnswer> parse_room_answer(Bytes body);

}  // namespace dance::wire
