// What the key of a peer lets it do on a server: which room it may enter, which names its guests
// may bear there, and what it may change.
//
// Units/frames: none.
// Ownership:    plain value, no allocation.
// Threads:      none inside.
// Failure:      none; what is not allowed is false.
#pragma once

#include <cstdint>
#include <optional>

#include "core/base/guest_id.h"
#include "tunnel/policy/owner_key.h"
#include "tunnel/wire/wire.h"

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
  bool any_name = false;  // a room's key: its holder chooses the names
  bool is_local = false;  // the key of programs on the server's own machine
  bool is_expired = false;
  std::optional<std::int64_t> until_s{};  // UTC at which the key expires; not set: never

  // Its own name, or one that begins with it and a '-': "alice", "alice-2".
  bool may_use_name(const GuestId& guest) const;
  bool may_enter(const wire::RoomName& wanted) const;
};

OwnerKey owner_key_of(const Access& access);

// Who may change what: all of it stands here.
bool may_have_guests(const Access& access);
bool may_send_records(const Access& access);
// To end the session of another guest of the room: a host.
bool may_remove_guests(const Access& access);
// Music, scene: what is one for the whole room. A host may; where nobody in the room has a host's
// key, any guest.
bool may_set_room_state(const Access& access, bool room_has_host);
// The house band's song: any guest may set it until a host locks it; only a host may lock it.
bool may_set_song(const Access& access, bool is_locked, bool locks);

}  // namespace dance
