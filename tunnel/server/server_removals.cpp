#include "tunnel/server/server_removals.h"

#include <array>

namespace dance {

void ServerRemovals::on_request(std::size_t session, wire::Bytes body, MonoTime now) {
  const auto request = wire::parse_removal_request(body);
  if (!request) return server_.reject(ServerReject::kMalformed);
  const PeerId from = server_.sessions[session].peer;
  const wire::RemovalAnswer answer{request->number, remove(session, request->guest, now)};
  std::array<std::uint8_t, 16> out;
  server_.send(from, {out.data(), wire::build(answer, out)});
}

wire::RemovalResult ServerRemovals::remove(std::size_t session, const GuestId& guest,
                                           MonoTime now) {
  ServerSession& from = server_.sessions[session];
  if (!may_remove_guests(from.access)) {
    server_.reject(ServerReject::kNotAllowed);
    return wire::RemovalResult::kNotAllowed;
  }
  ServerRoom& room = server_.rooms[from.room];
  const auto slot = ServerSlots::find(room, guest);
  if (!slot || room.guests[*slot].owner == session) return wire::RemovalResult::kNoSuchGuest;
  if (!from.removals.take(1.0, now)) return wire::RemovalResult::kTooMany;
  const ServerGuest& there = room.guests[*slot];
  if (server_.is_local(there)) {
    end(there.owner, from.access.name, now);
    return wire::RemovalResult::kDone;
  }
  if (server_.cluster != nullptr)
    server_.cluster->on_removal(room.name, {guest, there.link_token, {}, false});
  return wire::RemovalResult::kPassedOn;
}

// Removes all guests of the link: it is one house. `by` is the host's key, not set where the host
// is at another server of the cluster.
void ServerRemovals::end(std::size_t index, const GuestId& by, MonoTime now) {
  const ServerSession& session = server_.sessions[index];
  const ServerRoom& room = server_.rooms[session.room];
  AuditEvent event{.kind = AuditKind::kRemoved,
                   .key = session.access.name.view(),
                   .room = room.name,
                   .cause = "by_host",
                   .by = by};
  for (const std::uint8_t slot : session.slots) {
    if (!event.guests.try_push(room.guests[slot].id)) break;
  }
  server_.audit(session.peer, event);
  const wire::RoomName name = room.name;
  const GuestId key = session.access.any_name ? GuestId() : session.access.name;
  for (const std::uint8_t slot : session.slots) {
    const RemovalNotice notice{room.guests[slot].id, session.token, key, true};
    server_.bans.add(name, notice, now);
    if (server_.cluster != nullptr) server_.cluster->on_removal(name, notice);
  }
  ++server_.counters.sessions_removed;
  admission_.send_removal_notice(session.peer, 0, wire::kRemovedFor);
  admission_.drop(index);
}

void ServerRemovals::on_notice(const wire::RoomName& name, const RemovalNotice& notice,
                               MonoTime now) {
  if (notice.is_done) server_.bans.add(name, notice, now);
  const auto index = admission_.find_room(name);
  if (!index) return;
  // Its link may have come here meanwhile.
  const ServerRoom& room = server_.rooms[*index];
  const auto slot = ServerSlots::find(room, notice.guest);
  if (!slot || !server_.is_local(room.guests[*slot]) ||
      room.guests[*slot].link_token != notice.link_token)
    return;
  end(room.guests[*slot].owner, GuestId(), now);
}

void ServerRemovals::tell_rights(std::size_t index) {
  const ServerSession& session = server_.sessions[index];
  if (!may_remove_guests(session.access)) return;
  std::array<std::uint8_t, 8> out;
  server_.send(session.peer, {out.data(), wire::build(wire::Rights{true}, out)});
}

}  // namespace dance
