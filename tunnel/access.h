// What the key of a peer lets it do on a server: which room it may enter, and which names its guests
// may bear there.
//
// Units/frames: none.
// Ownership:    plain value, no allocation.
// Threads:      none inside.
// Failure:      none; what is not allowed is false.
#pragma once

#include <cstdint>

#include "core/base/guest_id.h"
#include "tunnel/wire.h"

namespace dance {

enum class Role : std::uint8_t {
  kGuest,     // dances
  kHost,      // dances, and changes what all of the room share
  kListener,  // only hears
};

struct Access {
  GuestId name{};  // of the key
  Role role = Role::kGuest;
  wire::RoomName room{};  // the only one it opens; not set = any room
  bool any_name = false;  // a room's key: whoever has it chooses the names

  // Its own name, or one that begins with it and a '-': "alice", "alice-2".
  bool may_bear(const GuestId& guest) const {
    if (role == Role::kListener || !guest.is_set()) return false;
    if (any_name) return true;
    const std::string_view own = name.view();
    const std::string_view wanted = guest.view();
    return name.is_set() && wanted.starts_with(own) &&
           (wanted.size() == own.size() || wanted[own.size()] == '-');
  }
  bool may_enter(const wire::RoomName& wanted) const { return !room.is_set() || room == wanted; }
};

}  // namespace dance
