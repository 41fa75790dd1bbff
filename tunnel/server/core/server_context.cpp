#include "tunnel/server/core/server_context.h"

#include <algorithm>
#include <utility>

#include "core/base/assert.h"

namespace dance {

ServerContext::ServerContext(const ServerLimits& of_server, PeerSink& to)
    : limits(of_server),
      sink(to),
      sessions(of_server.sessions + of_server.remote_servers),
      rooms(of_server.rooms),
      remote_receivers(of_server.remote_servers),
      keys(of_server.sessions) {
  DANCE_ASSERT(limits.guests_per_room <= wire::kSlotsPerPage, limits.guests_per_room);
  by_peer.reserve(limits.sessions);
  newcomers.reserve(limits.sessions);
  bundled.reserve(limits.sessions);
  reporting.reserve(sessions.size());
  speaking.reserve(limits.sessions);
  changed_rooms.reserve(limits.rooms);
  for (ServerRoom& room : rooms) room.members.reserve(sessions.size());
}

std::optional<wire::Refusal> ServerContext::full_for(const Access& access, bool wants_session,
                                                     bool wants_room) const {
  const KeyQuota quota = quota_of(access, limits);
  if (wants_session) {
    if (by_peer.size() == limits.sessions) return wire::Refusal::kServerFull;
    if (keys.sessions_of(access.name) >= quota.sessions) return wire::Refusal::kKeySessions;
  }
  if (wants_room) {
    std::size_t in_use = 0, opened = 0;
    for (const ServerRoom& room : rooms) {
      in_use += room.in_use ? 1 : 0;
      opened += room.in_use && room.opened_by == access.name ? 1 : 0;
    }
    if (in_use == rooms.size()) return wire::Refusal::kServerFull;
    if (opened >= quota.rooms) return wire::Refusal::kKeyRooms;
  }
  return std::nullopt;
}

bool ServerContext::admits(ServerSession& session, std::size_t datagram_bytes, MonoTime now) {
  if (!session.admits(datagram_bytes, now)) {
    reject(ServerReject::kSessionRate);
    return false;
  }
  if (!session.access.is_local && !keys.admits(session.key_use, datagram_bytes, now)) {
    reject(ServerReject::kKeyRate);
    return false;
  }
  return true;
}

void ServerContext::send(PeerId to, wire::Bytes bytes) {
  ++counters.datagrams_out;
  const std::size_t size = bytes.size() + wire::kSealOverhead;
  counters.bytes_out += size;
  if (const auto found = by_peer.find(to); found != by_peer.end())
    sessions[found->second].meter.went_out(size);
  sink.send(to, bytes);
}

ServerGuest* ServerContext::guest_of(std::size_t session, std::uint8_t slot) {
  ServerGuest& guest = rooms[sessions[session].room].guests[slot];
  return guest.in_use && guest.owner == session ? &guest : nullptr;
}

void ServerContext::mark_changed(ServerRoom& room) {
  if (std::exchange(room.is_listed, true)) return;
  changed_rooms.push_back(static_cast<std::size_t>(&room - rooms.data()));
}

bool ServerContext::is_newcomer(std::size_t session) const {
  return std::find(newcomers.begin(), newcomers.end(), session) != newcomers.end();
}

}  // namespace dance
