#include "tunnel/server/core/access.h"

namespace dance {

bool Access::may_use_name(const GuestId& guest) const {
  if (!may_have_guests(*this) || !guest.is_set()) return false;
  if (any_name) return true;
  const std::string_view own = name.view();
  const std::string_view wanted = guest.view();
  return name.is_set() && wanted.starts_with(own) &&
         (wanted.size() == own.size() || wanted[own.size()] == '-');
}

bool Access::may_enter(const wire::RoomName& wanted) const {
  return !room.is_set() || room == wanted;
}

bool may_have_guests(const Access& access) { return access.role != Role::kListener; }

bool may_send_records(const Access& access) { return may_have_guests(access); }

OwnerKey owner_key_of(const Access& access) { return {access.name, access.any_name}; }

bool may_remove_guests(const Access& access) { return access.role == Role::kHost; }

bool may_set_song(const Access& access, bool is_locked, bool locks) {
  return access.role == Role::kHost || (may_have_guests(access) && !is_locked && !locks);
}

bool may_set_room_state(const Access& access, bool room_has_host) {
  switch (access.role) {
    case Role::kHost:
      return true;
    case Role::kGuest:
      return !room_has_host;
    case Role::kListener:
      break;
  }
  return false;
}

}  // namespace dance
