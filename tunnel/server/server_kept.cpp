// What a newcomer is told at once, so that the stage is whole though nobody moves.
#include <algorithm>
#include <cstring>

#include "tunnel/server/server_core.h"

namespace dance {
namespace {

// Whose poses come more often shows up without the kept one.
constexpr Duration kStillMoves = Duration::ms(150);
constexpr std::size_t kStateDatagramsPerWelcome = 64;

}  // namespace

void ServerCore::keep(ServerGuest& guest, const wire::Record& record) {
  guest.kept.is_set = true;
  guest.kept.record = record;
  guest.kept.record.payload = {};
  guest.kept.record.is_kept = true;
  guest.kept.size = record.payload.size();
  std::memcpy(guest.kept.payload.data(), record.payload.data(), record.payload.size());
}

// Roster, then states, then poses: each needs the one before it. What does not fit comes with the
// pongs.
void ServerCore::greet(std::size_t newcomer, MonoTime now) {
  const ServerSession& session = sessions_[newcomer];
  const ServerRoom& room = rooms_[session.room];
  send_roster(session);
  send_states(newcomer, false, kStateDatagramsPerWelcome);
  for (std::uint8_t slot = 0; slot < room.guests.size(); ++slot) send_kept(newcomer, slot, now);
}

void ServerCore::send_kept(std::size_t to, std::uint8_t slot, MonoTime now) {
  const ServerGuest& guest = rooms_[sessions_[to].room].guests[slot];
  if (!guest.in_use || guest.owner == to || !guest.kept.is_set ||
      !sessions_[to].filters[slot].wants_any())
    return;
  wire::Record record = guest.kept.record;
  record.payload = {guest.kept.payload.data(), guest.kept.size};
  add_to_bundle(to, record, now);
}

// It may be lost, and nothing newer comes of who does not move: until the receiver has some pose.
void ServerCore::repeat_kept(std::size_t to, MonoTime now) {
  const ServerSession& session = sessions_[to];
  const ServerRoom& room = rooms_[session.room];
  for (std::uint8_t slot = 0; slot < room.guests.size(); ++slot) {
    const ServerGuest& guest = room.guests[slot];
    if (guest.in_use && guest.kept.is_set && now - guest.last_pose > kStillMoves &&
        !session.filters[slot].frames().is_of(guest.kept.record.stream))
      send_kept(to, slot, now);
  }
}

}  // namespace dance
