#include "tunnel/server_core.h"

#include <algorithm>
#include <cstring>

#include "core/base/assert.h"

namespace dance {
namespace {

constexpr Duration kSessionSilence = Duration::ms(1900);  // with the tick below: gone within 2 s
constexpr Duration kTick = Duration::ms(100);

}  // namespace

ServerCore::ServerCore(const ServerLimits& limits, RandomU64 random, PeerSink& sink)
    : limits_(limits),
      random_(std::move(random)),
      sink_(sink),
      sessions_(limits.sessions),
      rooms_(limits.rooms) {
  DANCE_ASSERT(limits.guests_per_room <= wire::kMaxGuestsPerRoom, limits.guests_per_room);
  by_peer_.reserve(limits.sessions);
  newcomers_.reserve(limits.sessions);
  bundled_.reserve(limits.sessions);
  reporting_.reserve(limits.sessions);
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
  // Its session fell silent and was dropped: the link hears nothing either, and says hello.
  if (found == by_peer_.end()) return reject(ServerReject::kNoSession);
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
      return on_state(index, opening.body);
    case wire::Type::kStateAck:
      return on_state_ack(index, opening.body);
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

void ServerCore::on_ping(std::size_t index, wire::Bytes body, MonoTime received, MonoTime now) {
  const auto ping = wire::parse_ping(body);
  if (!ping) return reject(ServerReject::kMalformed);
  ServerSession& session = sessions_[index];
  session.newest_ping = *ping;
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
  for (std::size_t slot = 0; slot < room.guests.size(); ++slot) {
    const ServerGuest& guest = room.guests[slot];
    if (guest.in_use && guest.owner != index && guest.state_version != session.state_acked[slot])
      send_state(session, static_cast<std::uint8_t>(slot));
  }
  repeat_kept(index, now);
}

ServerGuest* ServerCore::guest_of(std::size_t session, std::uint8_t slot) {
  ServerGuest& guest = rooms_[sessions_[session].room].guests[slot];
  return guest.in_use && guest.owner == session ? &guest : nullptr;
}

void ServerCore::on_state(std::size_t session, wire::Bytes body) {
  const auto state = wire::parse_state(body);
  if (!state) return reject(ServerReject::kMalformed);
  ServerGuest* guest = guest_of(session, state->slot.slot);
  if (guest == nullptr) return reject(ServerReject::kForeignSlot);
  const bool is_newer =
      guest->state_version == 0 || is_newer_sequence(state->version, guest->state_version);
  if (is_newer) {
    guest->state_version = state->version;
    guest->state_size = state->payload.size();
    std::memcpy(guest->state.data(), state->payload.data(), state->payload.size());
    for (const std::size_t member : rooms_[sessions_[session].room].members)
      if (member != session) send_state(sessions_[member], state->slot.slot);
  }
  const wire::StateAck ack{
      {state->slot.slot, guest->generation}, state->kind, guest->state_version};
  std::array<std::uint8_t, 32> out;
  send(sessions_[session].peer, {out.data(), wire::build(ack, out)});
}

void ServerCore::on_state_ack(std::size_t session, wire::Bytes body) {
  const auto ack = wire::parse_state_ack(body);
  if (!ack) return reject(ServerReject::kMalformed);
  const ServerGuest& guest = rooms_[sessions_[session].room].guests[ack->slot.slot];
  if (guest.in_use && guest.generation == ack->slot.generation)
    sessions_[session].state_acked[ack->slot.slot] = ack->version;
}

void ServerCore::send_state(const ServerSession& session, std::uint8_t slot) {
  const ServerGuest& guest = rooms_[session.room].guests[slot];
  wire::State state;
  state.slot = {slot, guest.generation};
  state.version = guest.state_version;
  state.payload = {guest.state.data(), guest.state_size};
  std::array<std::uint8_t, wire::kMaxPlain> out;
  send(session.peer, {out.data(), wire::build(state, out)});
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

void ServerCore::end_turn(MonoTime now) {
  for (ServerRoom& room : rooms_) {
    if (!room.roster_changed) continue;
    room.roster_changed = false;
    for (const std::size_t member : room.members) {
      settle_interest(member, now);
      const bool is_new =
          std::find(newcomers_.begin(), newcomers_.end(), member) != newcomers_.end();
      if (!is_new) send_roster(sessions_[member]);  // else below
    }
  }
  for (const std::size_t newcomer : newcomers_) greet(newcomer, now);
  newcomers_.clear();
  // Backwards, as who is done leaves the list.
  for (std::size_t i = bundled_.size(); i-- > 0;)
    if (is_bundle_due(sessions_[bundled_[i]], now)) flush_bundle(bundled_[i], now);
  for (std::size_t i = reporting_.size(); i-- > 0;) {
    const ServerSession& session = sessions_[reporting_[i]];
    // With a bundle under way it goes along.
    if (session.feedback_due <= now && session.bundle_size == 0) send_records(reporting_[i], now);
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
      session.feedback_is_repeat = true;  // what was said may be lost
      schedule_feedback(i, now);
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
  for (const std::size_t i : bundled_) next = std::min(next, sessions_[i].bundle_due);
  for (const std::size_t i : reporting_)
    if (sessions_[i].bundle_size == 0) next = std::min(next, sessions_[i].feedback_due);
  return next;
}

void ServerCore::say_goodbye() {
  for (const ServerSession& session : sessions_) {
    if (!session.in_use) continue;
    std::array<std::uint8_t, wire::kSessionHeader> out;
    send(session.peer, {out.data(), wire::build_bare(wire::Type::kGoodbye, out)});
  }
}

}  // namespace dance
