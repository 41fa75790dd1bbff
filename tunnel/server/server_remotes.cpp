#include "tunnel/server/server_remotes.h"

#include <algorithm>

#include "core/base/assert.h"

namespace dance {

ServerRoom* ServerRemotes::find(const wire::RoomName& name) {
  const auto index = admission_.find_room(name);
  return index ? &server_.rooms[*index] : nullptr;
}

std::optional<std::size_t> ServerRemotes::session_of(const ServerRoom& room,
                                                     ServerId server) const {
  for (const std::size_t member : room.members) {
    const ServerSession& session = server_.sessions[member];
    if (session.is_remote() && server_.remote_receivers[session.remote].server == server)
      return member;
  }
  return std::nullopt;
}

// Servers that let guests of one person's key in at the same moment learn of each other too late.
bool ServerRemotes::has_places_for(const ServerRoom& room, const OwnerKey& key) const {
  const auto has_key = [&](const ServerGuest& guest) { return guest.in_use && guest.key == key; };
  return key.is_shared || static_cast<std::size_t>(std::ranges::count_if(room.guests, has_key)) <
                              server_.limits.guests_per_key;
}

std::optional<ServerRemotes::Place> ServerRemotes::place_of(const wire::RoomName& name,
                                                            ServerId server, const GuestId& id,
                                                            std::uint64_t link_token) {
  const ServerRoom* room = find(name);
  const auto slot = room != nullptr ? ServerSlots::find(*room, id) : std::nullopt;
  const std::size_t owner = slot ? room->guests[*slot].owner : 0;
  if (!slot || !server_.sessions[owner].is_remote() ||
      server_.remote_receivers[server_.sessions[owner].remote].server != server ||
      room->guests[*slot].link_token != link_token) {
    ++counters_.unknown;
    return std::nullopt;
  }
  return Place{owner, *slot};
}

void ServerRemotes::settle(const wire::RoomName& name) {
  if (ServerRoom* room = find(name)) room->settled_at = MonoTime();
}

void ServerRemotes::open(const wire::RoomName& name, ServerId server, bool has_host, MonoTime now) {
  const auto index = admission_.find_room(name);
  if (!index) return;
  ServerRoom& room = server_.rooms[*index];
  if (!session_of(room, server) && !admission_.open_remote(*index, server, now))
    ++counters_.servers_without_place;
  if (const auto session = session_of(room, server)) {
    bool& known = server_.remote_receivers[server_.sessions[*session].remote].has_host;
    if (std::exchange(known, has_host) == has_host) return;
    room.remote_hosts = has_host ? room.remote_hosts + 1 : room.remote_hosts - 1;
  }
}

void ServerRemotes::close(const wire::RoomName& name, ServerId server) {
  const ServerRoom* room = find(name);
  if (room == nullptr) return;
  if (const auto session = session_of(*room, server)) admission_.drop(*session);
}

void ServerRemotes::note_alive(ServerId server, Duration round_trip, MonoTime now) {
  for (ServerSession& session : server_.sessions) {
    if (!session.in_use || !session.is_remote() ||
        server_.remote_receivers[session.remote].server != server)
      continue;
    session.last_heard = now;
    session.newest_ping.round_trip_us = static_cast<std::uint32_t>(round_trip.count_us());
  }
}

bool ServerRemotes::set_guest(const wire::RoomName& name, ServerId server, const GuestId& id,
                              std::uint64_t link_token, const OwnerKey& key, MonoTime now) {
  const auto index = admission_.find_room(name);
  if (!index) return true;
  ServerRoom& room = server_.rooms[*index];
  if (!session_of(room, server)) admission_.open_remote(*index, server, now);
  const auto session = session_of(room, server);
  if (!session) {
    ++counters_.servers_without_place;
    return false;
  }
  const auto slot = ServerSlots::find(room, id);
  if (!slot) {
    if (has_places_for(room, key) && slots_.add_guest(*session, id, link_token, key)) return true;
    ++counters_.guests_without_place;
    return false;
  }
  const std::size_t owner = room.guests[*slot].owner;
  const bool is_same_link = room.guests[*slot].link_token == link_token;
  if (owner == *session && is_same_link) return true;
  if (is_same_link) {
    slots_.move_guest(room, *slot, *session);
  } else {
    server_.sessions[owner].slots.erase(*slot);
    slots_.remove_guest(*index, *slot);
    const bool added = slots_.add_guest(*session, id, link_token, key).has_value();
    DANCE_ASSERT(added);  // there is the slot that was just left, if no other
  }
  // A link that has gone to another server with all of its guests. Last: the room may end with it.
  const ServerSession& before = server_.sessions[owner];
  if (owner != *session && !before.is_remote() && before.slots.empty()) admission_.drop(owner);
  return true;
}

void ServerRemotes::remove_guest(const wire::RoomName& name, ServerId server, const GuestId& id) {
  const auto index = admission_.find_room(name);
  if (!index) return;
  ServerRoom& room = server_.rooms[*index];
  const auto slot = ServerSlots::find(room, id);
  const auto session = session_of(room, server);
  if (!slot || !session || room.guests[*slot].owner != *session) return;
  slots_.remove_guest(*index, *slot);
  server_.sessions[*session].slots.erase(*slot);
}

void ServerRemotes::on_record(const wire::RoomName& name, ServerId server, const GuestId& id,
                              std::uint64_t link_token, wire::Record record, MonoTime now) {
  const auto place = place_of(name, server, id, link_token);
  if (!place) return;
  record.slot = place->slot;
  forwarder_.on_remote_record(place->session, record, now);
}

void ServerRemotes::on_record(const wire::RoomName& name, ServerId server, const GuestId& id,
                              std::uint64_t link_token, wire::VoiceRecord record, MonoTime now) {
  const auto place = place_of(name, server, id, link_token);
  if (!place) return;
  record.slot.slot = place->slot;
  voice_.on_remote_voice(place->session, record, now);
}

void ServerRemotes::on_feedback(const wire::RoomName& name, ServerId server, const GuestId& id,
                                const RemoteFeedback& feedback, MonoTime now) {
  const ServerRoom* room = find(name);
  const auto slot = room != nullptr ? ServerSlots::find(*room, id) : std::nullopt;
  const auto session = slot ? session_of(*room, server) : std::nullopt;
  if (!session || !server_.is_local(room->guests[*slot])) {
    ++counters_.unknown;
    return;
  }
  feedback_.on_remote_feedback(*session, *slot, feedback, now);
}

void ServerRemotes::on_file(const wire::RoomName& name, ServerId server, const GuestId& id,
                            const FilePart& part, MonoTime now) {
  const ServerRoom* room = find(name);
  const auto slot = room != nullptr ? ServerSlots::find(*room, id) : std::nullopt;
  const auto session = slot ? session_of(*room, server) : std::nullopt;
  if (!session) {
    ++counters_.unknown;
    return;
  }
  const wire::Slot here{*slot, room->guests[*slot].generation};
  std::visit(
      [&](auto of_file) {
        of_file.file.slot = here;
        files_.take(*session, of_file, now);
      },
      part);
}

void ServerRemotes::on_state(const wire::RoomName& name, const GuestId& id,
                             const wire::State& state) {
  ServerRoom* room = find(name);
  if (room == nullptr) return;
  if (!id.is_set()) return states_.on_remote_state(*room, nullptr, state);
  const auto slot = ServerSlots::find(*room, id);
  if (slot && !server_.is_local(room->guests[*slot]))
    states_.on_remote_state(*room, &room->guests[*slot], state);
}

void ServerRemotes::repeat_feedback(MonoTime now) {
  for (std::size_t i = 0; i < server_.sessions.size(); ++i)
    if (server_.sessions[i].in_use && server_.sessions[i].is_remote()) feedback_.repeat(i, now);
}

}  // namespace dance
