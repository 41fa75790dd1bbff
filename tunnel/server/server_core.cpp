#include "tunnel/server/server_core.h"

#include <algorithm>

#include "core/base/assert.h"

namespace dance {
namespace {

constexpr Duration kSessionSilence = Duration::ms(1900);  // with the tick below: gone within 2 s
constexpr Duration kTick = Duration::ms(100);
// What a link has not acknowledged; the rest comes with the next pong.
constexpr std::size_t kStateDatagramsPerPong = 32;

}  // namespace

ServerCore::ServerCore(const ServerLimits& limits, RandomU64 random, PeerSink& sink)
    : limits_(limits),
      random_(std::move(random)),
      sink_(sink),
      sessions_(limits.sessions),
      rooms_(limits.rooms) {
  DANCE_ASSERT(limits.guests_per_room <= wire::kMaxGuestsPerRoom, limits.guests_per_room);
  hellos_.fill(TokenBucket(limits.hellos_per_second, limits.hello_burst));
  by_peer_.reserve(limits.sessions);
  newcomers_.reserve(limits.sessions);
  bundled_.reserve(limits.sessions);
  reporting_.reserve(limits.sessions);
  astir_.reserve(limits.rooms);
  for (ServerRoom& room : rooms_) room.members.reserve(limits.sessions);
}

std::size_t ServerCore::room_count() const {
  return static_cast<std::size_t>(
      std::count_if(rooms_.begin(), rooms_.end(), [](const auto& room) { return room.in_use; }));
}

std::size_t ServerCore::guest_count() const {
  std::size_t count = 0;
  for (const ServerSession& session : sessions_)
    if (session.in_use) count += session.slots.size();
  return count;
}

std::size_t ServerCore::listener_count() const {
  return static_cast<std::size_t>(
      std::count_if(sessions_.begin(), sessions_.end(),
                    [](const auto& session) { return session.in_use && session.slots.empty(); }));
}

void ServerCore::send(PeerId to, wire::Bytes bytes) {
  ++counters_.datagrams_out;
  const std::size_t size = bytes.size() + wire::kSealOverhead;
  counters_.bytes_out += size;
  if (const auto found = by_peer_.find(to); found != by_peer_.end())
    sessions_[found->second].meter.went_out(size);
  sink_.send(to, bytes);
}

void ServerCore::receive(PeerId from, const Access& access, wire::Bytes datagram, MonoTime received,
                         MonoTime now) {
  DANCE_ASSERT(from != 0);
  ++counters_.datagrams_in;
  counters_.bytes_in += datagram.size() + wire::kSealOverhead;
  const auto opening = wire::parse_opening(datagram);
  if (!opening) return reject(ServerReject::kTooShort);
  const auto found = by_peer_.find(from);
  if (found != by_peer_.end()) {
    ServerSession& session = sessions_[found->second];
    if (!session.datagrams.take(1.0, now) ||
        !session.bytes.take(static_cast<double>(datagram.size()), now))
      return reject(ServerReject::kSessionRate);
    session.meter.came_in(datagram.size() + wire::kSealOverhead, now);
  }
  if (opening->type == wire::Type::kHello)
    return on_hello(from, access, opening->body, received, now);
  // Its session fell silent and was dropped. What is still under way to it may hide that.
  if (found == by_peer_.end()) {
    if (opening->type == wire::Type::kPing) send_away(from);
    return reject(ServerReject::kNoSession);
  }
  on_session_datagram(found->second, *opening, received, now);
}

void ServerCore::forget(PeerId peer) {
  const auto found = by_peer_.find(peer);
  if (found != by_peer_.end()) drop_session(found->second);
}

void ServerCore::on_session_datagram(std::size_t index, const wire::Opening& opening,
                                     MonoTime received, MonoTime now) {
  ServerSession& session = sessions_[index];
  session.last_heard = now;
  ++session.datagrams_received;
  switch (opening.type) {
    case wire::Type::kPing:
      return on_ping(index, opening.body, received, now);
    case wire::Type::kRecords:
      return on_records(index, opening.body, received, now);
    case wire::Type::kState:
      return on_states(index, opening.body, now);
    case wire::Type::kStateAck:
      return on_state_acks(index, opening.body);
    case wire::Type::kInterest:
      return on_interest(index, opening.body, now);
    case wire::Type::kGoodbye:
      if (!opening.body.empty()) return reject(ServerReject::kMalformed);
      ++counters_.goodbyes;
      return drop_session(index);
    default:
      return reject(ServerReject::kUnknownType);
  }
}

// It says hello at once, instead of when it has heard nothing for long.
void ServerCore::send_away(PeerId peer) {
  std::array<std::uint8_t, wire::kSessionHeader> out;
  send(peer, {out.data(), wire::build_bare(wire::Type::kGoodbye, out)});
}

void ServerCore::on_ping(std::size_t index, wire::Bytes body, MonoTime received, MonoTime now) {
  const auto ping = wire::parse_ping(body);
  if (!ping) return reject(ServerReject::kMalformed);
  ServerSession& session = sessions_[index];
  // Its welcome was lost, or is under way still.
  if (ping->epoch != static_cast<std::uint32_t>(session.epoch)) return send_away(session.peer);
  session.newest_ping = *ping;
  session.knows_epoch = true;
  wire::Pong pong;
  pong.sequence = ping->sequence;
  pong.link_time_us = ping->link_time_us;
  // A datagram may come in after the turn began and be of that turn all the same.
  pong.server_receive_us = received.since_zero_us();
  pong.server_send_us = std::max(now, received).since_zero_us();
  pong.datagrams_received = session.datagrams_received;
  std::array<std::uint8_t, 64> out;
  send(session.peer, {out.data(), wire::build(pong, out)});

  // Each ping is the occasion to repeat what the link has not acknowledged.
  const ServerRoom& room = rooms_[session.room];
  if (ping->roster_version != room.roster_version) send_roster(session);
  send_states(index, false, kStateDatagramsPerPong);
  repeat_kept(index, now);
}

ServerGuest* ServerCore::guest_of(std::size_t session, std::uint8_t slot) {
  ServerGuest& guest = rooms_[sessions_[session].room].guests[slot];
  return guest.in_use && guest.owner == session ? &guest : nullptr;
}

void ServerCore::send_roster(const ServerSession& session) {
  const ServerRoom& room = rooms_[session.room];
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
    send(session.peer, {out.data(), size});
  }
}

void ServerCore::stir(ServerRoom& room) {
  if (std::exchange(room.is_astir, true)) return;
  astir_.push_back(static_cast<std::size_t>(&room - rooms_.data()));
}

void ServerCore::end_turn(MonoTime now) {
  for (const std::size_t i : astir_) {
    ServerRoom& room = rooms_[i];
    if (!room.roster_changed) continue;
    room.roster_changed = false;
    for (const std::size_t member : room.members) {
      settle_interest(member, now);
      if (!is_newcomer(member)) send_roster(sessions_[member]);  // else below
    }
  }
  // Those who dance come first: what a newcomer is told may be much.
  flush_due(now);
  if (!newcomers_.empty()) {
    for (const std::size_t newcomer : newcomers_) greet(newcomer, now);
    newcomers_.clear();
    flush_due(now);
  }
  // Last, so that nothing waits for them.
  for (const std::size_t i : astir_)
    if (rooms_[i].has_fresh_states && now >= rooms_[i].fresh_states_due)
      send_fresh_states(rooms_[i], now);
  std::erase_if(astir_, [this](std::size_t i) {
    rooms_[i].is_astir = rooms_[i].roster_changed || rooms_[i].has_fresh_states;
    return !rooms_[i].is_astir;
  });
}

bool ServerCore::is_newcomer(std::size_t session) const {
  return std::find(newcomers_.begin(), newcomers_.end(), session) != newcomers_.end();
}

// Bundles and feedback; not to who has no roster yet.
void ServerCore::flush_due(MonoTime now) {
  // Who has waited longest comes first, and leaves the list.
  for (std::size_t i = 0; i < bundled_.size();) {
    if (is_bundle_due(sessions_[bundled_[i]], now) && !is_newcomer(bundled_[i]))
      flush_bundle(bundled_[i], now);
    else
      ++i;
  }
  // Backwards, as who is done leaves this one too.
  for (std::size_t i = reporting_.size(); i-- > 0;) {
    const ServerSession& session = sessions_[reporting_[i]];
    // With a bundle under way it goes along.
    if (session.feedback_alone <= now && session.stream.bundle.is_empty() &&
        !is_newcomer(reporting_[i]))
      send_records(reporting_[i], now);
  }
}

void ServerCore::sweep(MonoTime now) {
  for (std::size_t i = 0; i < sessions_.size(); ++i) {
    ServerSession& session = sessions_[i];
    if (!session.in_use) continue;
    if (now - session.last_heard > kSessionSilence) {
      ++counters_.sessions_timed_out;
      drop_session(i);
    } else {
      repeat_feedback(i, now);
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
  if (by_peer_.empty()) return MonoTime();
  MonoTime next = next_sweep_.is_set() ? next_sweep_ : MonoTime::from_ns(1);
  for (const std::size_t i : bundled_) next = std::min(next, sessions_[i].stream.bundle.due());
  for (const std::size_t i : reporting_)
    if (sessions_[i].stream.bundle.is_empty()) next = std::min(next, sessions_[i].feedback_alone);
  for (const std::size_t i : astir_)
    if (const ServerRoom& room = rooms_[i]; room.has_fresh_states)
      next = std::min(next, room.fresh_states_due);
  return next;
}

void ServerCore::say_goodbye() {
  for (const ServerSession& session : sessions_) {
    if (!session.in_use) continue;
    send_away(session.peer);
  }
}

}  // namespace dance
