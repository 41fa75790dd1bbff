#include "tunnel/server/server_sync.h"

#include <algorithm>

#include "core/base/assert.h"

namespace dance {
namespace {

// Of a cluster: every so many pings a link is told the other servers again.
constexpr std::uint32_t kPingsPerServers = 8;
// What a link has not acknowledged; the rest comes with the next pong.
constexpr std::size_t kStateDatagramsPerPong = 32;
constexpr std::size_t kStateDatagramsPerWelcome = 64;

}  // namespace

// Roster, then states, then poses: each needs the one before it.
void ServerSync::send_all(std::size_t newcomer, MonoTime now) {
  const ServerRoom& room = server_.rooms[server_.sessions[newcomer].room];
  send_roster(newcomer);
  states_.send(newcomer, false, kStateDatagramsPerWelcome);
  for (std::uint8_t slot = 0; slot < room.guests.size(); ++slot)
    forwarder_.send_retained(newcomer, slot, now);
}

void ServerSync::repeat(std::size_t index, const wire::Ping& ping, MonoTime now) {
  const ServerSession& session = server_.sessions[index];
  // The list may have been lost; a server that stands alone has none.
  if (!server_.other_servers.empty() && ping.sequence % kPingsPerServers == 1)
    send_servers(session);
  if (ping.roster_version != server_.rooms[session.room].roster_version) send_roster(index);
  repeat_states(index);
  forwarder_.repeat_retained(index, now);
}

void ServerSync::repeat_states(std::size_t index) {
  states_.send(index, false, kStateDatagramsPerPong);
}

void ServerSync::send_roster(std::size_t index) {
  const ServerSession& session = server_.sessions[index];
  const ServerRoom& room = server_.rooms[session.room];
  constexpr std::uint8_t kSpan = wire::kSlotsPerRosterPart;
  constexpr auto kParts = static_cast<std::uint8_t>(wire::kMaxGuestsPerRoom / kSpan);
  for (std::uint8_t part = 0; part < kParts; ++part) {
    wire::RosterPart roster;
    roster.version = room.roster_version;
    roster.part = part;
    roster.parts = kParts;
    roster.first_slot = static_cast<std::uint8_t>(part * kSpan);
    roster.slot_span = kSpan;
    for (std::uint8_t i = 0; i < kSpan; ++i) {
      const auto slot = static_cast<std::uint8_t>(roster.first_slot + i);
      const ServerGuest& guest = room.guests[slot];
      if (!guest.in_use) continue;
      const bool pushed = roster.entries.try_push({{slot, guest.generation}, guest.id});
      DANCE_ASSERT(pushed);
    }
    std::array<std::uint8_t, wire::kMaxPlain> out;
    const std::size_t size = wire::build(roster, out);
    DANCE_ASSERT(size > 0);
    server_.send(session.peer, {out.data(), size});
  }
}

void ServerSync::set_other_servers(const wire::ServerList& servers) {
  if (std::ranges::equal(servers, server_.other_servers)) return;
  server_.other_servers = servers;
  for (const ServerSession& session : server_.sessions)
    if (session.in_use && !session.is_remote() && session.knows_epoch) send_servers(session);
}

void ServerSync::send_servers(const ServerSession& session) {
  std::array<std::uint8_t, wire::kMaxPlain> out;
  server_.send(session.peer, {out.data(), wire::build(server_.other_servers, out)});
}

}  // namespace dance
