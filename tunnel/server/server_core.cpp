#include "tunnel/server/server_core.h"

#include <algorithm>

#include "core/base/assert.h"
#include "core/base/deadline.h"

namespace dance {
namespace {

constexpr Duration kSessionSilence = Duration::ms(1900);  // with the tick below: gone within 2 s
constexpr Duration kTick = Duration::ms(100);
// Other servers are told again what may have been lost.
constexpr std::uint64_t kSweepsPerRepeat = 5;
// So often the other servers of a cluster are told again.
constexpr std::uint32_t kPingsPerServers = 8;
// What a link has not acknowledged; the rest comes with the next pong.
constexpr std::size_t kStateDatagramsPerPong = 32;
constexpr std::size_t kStateDatagramsPerWelcome = 64;

}  // namespace

std::size_t ServerCore::room_count() const {
  return static_cast<std::size_t>(std::count_if(server_.rooms.begin(), server_.rooms.end(),
                                                [](const auto& room) { return room.in_use; }));
}

std::size_t ServerCore::guest_count() const {
  std::size_t count = 0;
  for (const ServerSession& session : server_.sessions)
    if (session.in_use && !session.is_remote()) count += session.slots.size();
  return count;
}

std::size_t ServerCore::listener_count() const {
  return static_cast<std::size_t>(std::count_if(
      server_.sessions.begin(), server_.sessions.end(), [](const ServerSession& session) {
        return session.in_use && !session.is_remote() && session.slots.empty();
      }));
}

void ServerCore::receive(PeerId from, const Access& access, wire::Bytes datagram, MonoTime received,
                         MonoTime now) {
  DANCE_ASSERT(from != 0);
  ++server_.counters.datagrams_in;
  server_.counters.bytes_in += datagram.size() + wire::kSealOverhead;
  const auto opening = wire::parse_opening(datagram);
  if (!opening) return server_.reject(ServerReject::kTooShort);
  const auto found = server_.by_peer.find(from);
  if (found != server_.by_peer.end()) {
    ServerSession& session = server_.sessions[found->second];
    if (!session.datagrams.take(1.0, now) ||
        !session.bytes.take(static_cast<double>(datagram.size()), now))
      return server_.reject(ServerReject::kSessionRate);
    session.meter.came_in(datagram.size() + wire::kSealOverhead, now);
  }
  if (opening->type == wire::Type::kHello)
    return admission_.on_hello(from, access, opening->body, received, now);
  // Its session fell silent and was dropped. What is still under way to it may hide that.
  if (found == server_.by_peer.end()) {
    if (opening->type == wire::Type::kPing) send_goodbye(from);
    return server_.reject(ServerReject::kNoSession);
  }
  on_session_datagram(found->second, *opening, received, now);
}

void ServerCore::forget(PeerId peer) {
  const auto found = server_.by_peer.find(peer);
  if (found != server_.by_peer.end()) admission_.drop(found->second);
}

void ServerCore::on_session_datagram(std::size_t index, const wire::Opening& opening,
                                     MonoTime received, MonoTime now) {
  ServerSession& session = server_.sessions[index];
  session.last_heard = now;
  ++session.datagrams_received;
  switch (opening.type) {
    case wire::Type::kPing:
      return on_ping(index, opening.body, received, now);
    case wire::Type::kRecords:
      return forwarder_.on_records(index, opening.body, received, now);
    case wire::Type::kVoices:
      return voice_.on_voices(index, opening.body, received, now);
    case wire::Type::kState:
      return states_.on_states(index, opening.body, now);
    case wire::Type::kStateAck:
      return states_.on_acks(index, opening.body);
    case wire::Type::kInterest:
      return interest_.on_interest(index, opening.body, now);
    case wire::Type::kFileTerms:
      if (files_.on_terms(index, opening.body)) states_.send(index, false, kStateDatagramsPerPong);
      return;
    case wire::Type::kFileWant:
      return files_.on_want(index, opening.body, now);
    case wire::Type::kFileChunk:
      return files_.on_chunk(index, opening.body, now);
    case wire::Type::kFileRefusal:
      return files_.on_refusal(index, opening.body, now);
    case wire::Type::kGoodbye:
      if (!opening.body.empty()) return server_.reject(ServerReject::kMalformed);
      ++server_.counters.goodbyes;
      return admission_.drop(index);
    default:
      return server_.reject(ServerReject::kUnknownType);
  }
}

// The link says hello at once, instead of when it has heard nothing for long.
void ServerCore::send_goodbye(PeerId peer) {
  std::array<std::uint8_t, wire::kSessionHeader> out;
  server_.send(peer, {out.data(), wire::build_bare(wire::Type::kGoodbye, out)});
}

void ServerCore::on_ping(std::size_t index, wire::Bytes body, MonoTime received, MonoTime now) {
  const auto ping = wire::parse_ping(body);
  if (!ping) return server_.reject(ServerReject::kMalformed);
  ServerSession& session = server_.sessions[index];
  // Its welcome was lost, or is under way still.
  if (ping->epoch != static_cast<std::uint32_t>(session.epoch)) return send_goodbye(session.peer);
  session.newest_ping = *ping;
  session.knows_epoch = true;
  pace_.on_ping(index, now);
  wire::Pong pong;
  pong.sequence = ping->sequence;
  pong.link_time_us = ping->link_time_us;
  // A datagram may come in after the turn began and be of that turn all the same.
  pong.server_receive_us = received.since_zero_us();
  pong.server_send_us = std::max(now, received).since_zero_us();
  pong.datagrams_received = session.datagrams_received;
  std::array<std::uint8_t, 64> out;
  server_.send(session.peer, {out.data(), wire::build(pong, out)});

  // It is told all in one, when the room is known.
  if (server_.is_newcomer(index)) return;
  // The list may have been lost; of a server that stands alone there is none.
  if (!server_.other_servers.empty() && ping->sequence % kPingsPerServers == 1)
    send_servers(session);
  // Each ping is the occasion to repeat what the link has not acknowledged.
  const ServerRoom& room = server_.rooms[session.room];
  if (ping->roster_version != room.roster_version) send_roster(session);
  states_.send(index, false, kStateDatagramsPerPong);
  forwarder_.repeat_retained(index, now);
}

void ServerCore::send_roster(const ServerSession& session) {
  const ServerRoom& room = server_.rooms[session.room];
  constexpr std::uint8_t kSpan = wire::kSlotsPerRosterPart;
  constexpr auto kPage = static_cast<std::uint8_t>(wire::kSlotsPerPage / kSpan);
  constexpr auto kAll = static_cast<std::uint8_t>(wire::kMaxGuestsPerRoom / kSpan);
  const std::uint8_t parts = session.can_name(wire::kSlotsPerPage) ? kAll : kPage;
  for (std::uint8_t part = 0; part < parts; ++part) {
    wire::RosterPart roster;
    roster.version = room.roster_version;
    roster.part = part;
    roster.parts = parts;
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

void ServerCore::end_turn(MonoTime now) {
  for (const std::size_t i : server_.changed_rooms) {
    ServerRoom& room = server_.rooms[i];
    if (!room.roster_changed) continue;
    room.roster_changed = false;
    for (const std::size_t member : room.members) {
      if (server_.sessions[member].is_remote()) continue;
      interest_.settle(member, now);
      if (!server_.is_newcomer(member)) send_roster(server_.sessions[member]);  // else below
    }
  }
  for (const std::size_t i : server_.changed_rooms)
    if (server_.rooms[i].interest_changed && server_.rooms[i].in_use)
      interest_.tell_wanted(server_.rooms[i]);
  // Those who dance come first: what a newcomer is told may be much.
  forwarder_.flush_due(now);
  const auto is_greeted = [&](std::size_t newcomer) {
    ServerRoom& room = server_.rooms[server_.sessions[newcomer].room];
    if (room.settled_at.is_set() && now < room.settled_at) return false;
    room.settled_at = MonoTime();
    greet(newcomer, now);
    return true;
  };
  if (std::erase_if(server_.newcomers, is_greeted) > 0) forwarder_.flush_due(now);
  voice_.send_due(now);
  // Last, so that nothing waits for them.
  for (const std::size_t i : server_.changed_rooms)
    if (server_.rooms[i].has_fresh_states && now >= server_.rooms[i].fresh_states_due)
      states_.send_fresh(server_.rooms[i], now);
  files_.send_due(now);
  std::erase_if(server_.changed_rooms, [this](std::size_t i) {
    server_.rooms[i].is_listed =
        server_.rooms[i].roster_changed || server_.rooms[i].has_fresh_states;
    return !server_.rooms[i].is_listed;
  });
}

void ServerCore::sweep(MonoTime now) {
  if (++sweeps_ % kSweepsPerRepeat == 0) remotes_.repeat_feedback(now);
  files_.forget_absent();
  pace_.sample(now);
  for (std::size_t i = 0; i < server_.sessions.size(); ++i) {
    ServerSession& session = server_.sessions[i];
    if (!session.in_use || session.is_remote()) continue;
    if (now - session.last_heard > kSessionSilence) {
      ++server_.counters.sessions_timed_out;
      admission_.drop(i);
    } else {
      feedback_.repeat(i, now);
    }
  }
}

MonoTime ServerCore::tick(MonoTime now) {
  if (now >= next_sweep_) {
    sweep(now);
    next_sweep_ = now + kTick;
  }
  end_turn(now);
  return next_deadline();
}

MonoTime ServerCore::next_deadline() const {
  if (server_.by_peer.empty()) return MonoTime();
  MonoTime next = next_sweep_.is_set() ? next_sweep_ : MonoTime::from_ns(1);
  for (const std::size_t i : server_.bundled)
    next = std::min(next, server_.sessions[i].stream.bundle.due());
  for (const std::size_t i : server_.reporting)
    if (server_.sessions[i].is_remote())
      next = std::min(next, server_.sessions[i].feedback_due);
    else if (server_.sessions[i].stream.bundle.is_empty())
      next = std::min(next, server_.sessions[i].feedback_alone);
  for (const std::size_t i : server_.changed_rooms)
    if (const ServerRoom& room = server_.rooms[i]; room.has_fresh_states)
      next = std::min(next, room.fresh_states_due);
  next = earlier(next, voice_.next_deadline());
  for (const std::size_t i : server_.newcomers)
    next = std::min(next, server_.rooms[server_.sessions[i].room].settled_at);
  return earlier(next, files_.next_deadline());
}

void ServerCore::end_sessions() {
  say_goodbye();
  for (std::size_t i = 0; i < server_.sessions.size(); ++i)
    if (server_.sessions[i].in_use && !server_.sessions[i].is_remote()) admission_.drop(i);
  next_sweep_ = MonoTime();
}

void ServerCore::say_goodbye() {
  for (const ServerSession& session : server_.sessions) {
    if (session.in_use && !session.is_remote()) send_goodbye(session.peer);
  }
}

void ServerCore::set_other_servers(const wire::ServerList& servers) {
  if (std::ranges::equal(servers, server_.other_servers)) return;
  server_.other_servers = servers;
  for (const ServerSession& session : server_.sessions)
    if (session.in_use && !session.is_remote() && session.knows_epoch) send_servers(session);
}

void ServerCore::send_servers(const ServerSession& session) {
  std::array<std::uint8_t, wire::kMaxPlain> out;
  server_.send(session.peer, {out.data(), wire::build(server_.other_servers, out)});
}

// Roster, then states, then poses: each needs the one before it. What does not fit comes with the
// pongs.
void ServerCore::greet(std::size_t newcomer, MonoTime now) {
  const ServerSession& session = server_.sessions[newcomer];
  const ServerRoom& room = server_.rooms[session.room];
  send_roster(session);
  states_.send(newcomer, false, kStateDatagramsPerWelcome);
  for (std::uint8_t slot = 0; slot < room.guests.size(); ++slot)
    forwarder_.send_retained(newcomer, slot, now);
}

}  // namespace dance
