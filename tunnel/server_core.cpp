#include "tunnel/server_core.h"

#include <algorithm>
#include <cstring>

#include "core/base/assert.h"

namespace dance {
namespace {

constexpr Duration kSilenceLimit = Duration::ms(1900);  // with the tick below: gone within 2 s
constexpr Duration kUnprovenLimit = Duration::s(1);
constexpr Duration kTick = Duration::ms(100);
// A capture further from now than this is no capture of a dance under way.
constexpr std::int64_t kLongestAge_us = 60'000'000;
// Nothing is captured in the future; clocks are mapped better than this.
constexpr std::int64_t kFarthestAhead_us = 1'000'000;

}  // namespace

ServerCore::ServerCore(const ServerLimits& limits, RandomU64 random, DatagramSink& sink)
    : limits_(limits),
      random_(std::move(random)),
      sink_(sink),
      sessions_(limits.sessions),
      rooms_(limits.rooms),
      strangers_(limits.strangers_per_second, limits.stranger_burst) {
  DANCE_ASSERT(limits.guests_per_room <= wire::kMaxGuestsPerRoom, limits.guests_per_room);
  by_id_.reserve(limits.sessions);
  bundled_.reserve(limits.sessions);
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

void ServerCore::send(const Address& to, wire::Bytes bytes) {
  ++counters_.datagrams_out;
  counters_.bytes_out += bytes.size();
  sink_.send(to, bytes);
}

void ServerCore::receive(const Address& from, wire::Bytes datagram, MonoTime received,
                         MonoTime now) {
  ++counters_.datagrams_in;
  counters_.bytes_in += datagram.size();
  const auto opening = wire::parse_opening(datagram);
  if (!opening) return reject(ServerReject::kTooShort);
  if (opening->has_magic) {
    if (opening->type != wire::Type::kHello) return reject(ServerReject::kUnknownType);
    return on_hello(from, *opening, received, now);
  }
  const auto found = by_id_.find(opening->session);
  if (found == by_id_.end()) {
    reject(ServerReject::kUnknownSession);
    return answer_unknown(from, *opening, now);
  }
  ServerSession& session = sessions_[found->second];
  if (session.address != from) {
    // The link moved (another network, another translation of its address): it says hello again
    // when it hears this, and its token gives it its place back.
    reject(ServerReject::kWrongAddress);
    return answer_unknown(from, *opening, now);
  }
  if (!session.datagrams.take(1.0, now) ||
      !session.bytes.take(static_cast<double>(datagram.size()), now))
    return reject(ServerReject::kSessionRate);
  on_session_datagram(found->second, *opening, received, now);
}

// Lets a link notice at once that the server began anew. Never longer than what it answers.
void ServerCore::answer_unknown(const Address& to, const wire::Opening& opening, MonoTime now) {
  if (opening.type == wire::Type::kGoodbye || opening.type == wire::Type::kUnknownSession) return;
  if (!strangers_.take(1.0, now)) return reject(ServerReject::kStrangerRate);
  std::array<std::uint8_t, wire::kSessionHeader> out;
  const std::size_t size = wire::build_bare(opening.session, wire::Type::kUnknownSession, out);
  send(to, {out.data(), size});
}

void ServerCore::on_session_datagram(std::size_t index, const wire::Opening& opening,
                                     MonoTime received, MonoTime now) {
  ServerSession& session = sessions_[index];
  session.last_heard = now;
  session.is_proven = true;
  ++session.datagrams_received;
  switch (opening.type) {
    case wire::Type::kPing:
      return on_ping(index, opening.body, received, now);
    case wire::Type::kRecords:
      return on_records(index, opening.body, received);
    case wire::Type::kState:
      return on_state(index, opening.body);
    case wire::Type::kStateAck:
      return on_state_ack(index, opening.body);
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
  send(session.address, {out.data(), wire::build(session.id, pong, out)});

  // Each ping is the occasion to repeat what the link has not acknowledged.
  const ServerRoom& room = rooms_[session.room];
  if (ping->roster_version != room.roster_version) send_roster(session);
  for (std::size_t slot = 0; slot < room.guests.size(); ++slot) {
    const ServerGuest& guest = room.guests[slot];
    if (guest.in_use && guest.owner != index && guest.state_version != session.state_acked[slot])
      send_state(session, static_cast<std::uint8_t>(slot));
  }
}

ServerGuest* ServerCore::guest_of(std::size_t session, std::uint8_t slot) {
  ServerGuest& guest = rooms_[sessions_[session].room].guests[slot];
  return guest.in_use && guest.owner == session ? &guest : nullptr;
}

void ServerCore::on_records(std::size_t session, wire::Bytes body, MonoTime received) {
  // All of a datagram or nothing: half of a damaged one is not worth more than none.
  ByteReader check(body);
  if (body.empty()) return reject(ServerReject::kMalformed);
  while (!check.is_exhausted())
    if (!wire::parse_record(check)) return reject(ServerReject::kMalformed);
  ByteReader in(body);
  while (!in.is_exhausted()) on_record(session, *wire::parse_record(in), received);
}

void ServerCore::on_record(std::size_t session, wire::Record record, MonoTime received) {
  ServerGuest* guest = guest_of(session, record.slot);
  if (guest == nullptr) return reject(ServerReject::kForeignSlot);
  const std::int64_t received_us = received.since_zero_us();
  if (record.capture_us < received_us - kLongestAge_us ||
      record.capture_us > received_us + kFarthestAhead_us)
    return reject(ServerReject::kBadTime);
  const bool is_pose = record.kind == wire::RecordKind::kPose;
  const std::uint8_t codec = is_pose ? rooms_[sessions_[session].room].codec : std::uint8_t{0};
  if (record.codec != codec) return reject(ServerReject::kWrongCodec);

  record.stream = std::uint32_t{guest->generation} << 16 | (record.stream & 0xffff);
  StreamGate& gate = is_pose ? guest->poses : guest->hands;
  switch (gate.judge(record.stream, record.sequence, record.capture_us)) {
    case StreamGate::Verdict::kNewest:
    case StreamGate::Verdict::kNewStream:
      break;
    case StreamGate::Verdict::kDuplicate:
      return reject(ServerReject::kDuplicate);
    case StreamGate::Verdict::kLate:
    case StreamGate::Verdict::kOldStream:
      return reject(ServerReject::kLate);
  }
  record.server_age_us = static_cast<std::int32_t>(received_us - record.capture_us);
  ++counters_.records_in;
  forward(session, record);
}

void ServerCore::forward(std::size_t from, const wire::Record& record) {
  std::array<std::uint8_t, wire::kRecordHeader + wire::kMaxPayload> bytes;
  ByteWriter built(bytes);
  wire::add_record(record, built);
  DANCE_ASSERT(built.ok());
  for (const std::size_t member : rooms_[sessions_[from].room].members) {
    ServerSession& to = sessions_[member];
    if (member == from || !to.is_proven) continue;
    if (to.bundle_size != 0 && to.bundle.size() - to.bundle_size < built.size()) flush_bundle(to);
    if (to.bundle_size == 0) {
      ByteWriter opening(to.bundle);
      wire::begin_records(to.id, opening);
      to.bundle_size = opening.size();
      bundled_.push_back(member);
    }
    std::memcpy(to.bundle.data() + to.bundle_size, bytes.data(), built.size());
    to.bundle_size += built.size();
    ++counters_.records_out;
  }
}

void ServerCore::flush_bundle(ServerSession& session) {
  send(session.address, {session.bundle.data(), session.bundle_size});
  session.bundle_size = 0;
  std::erase(bundled_, static_cast<std::size_t>(&session - sessions_.data()));
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
      if (member != session && sessions_[member].is_proven)
        send_state(sessions_[member], state->slot.slot);
  }
  const wire::StateAck ack{
      {state->slot.slot, guest->generation}, state->kind, guest->state_version};
  std::array<std::uint8_t, 32> out;
  send(sessions_[session].address, {out.data(), wire::build(sessions_[session].id, ack, out)});
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
  std::array<std::uint8_t, wire::kMaxDatagram> out;
  send(session.address, {out.data(), wire::build(session.id, state, out)});
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
    std::array<std::uint8_t, wire::kMaxDatagram> out;
    const std::size_t size = wire::build(session.id, roster, out);
    DANCE_ASSERT(size > 0);
    send(session.address, {out.data(), size});
  }
}

void ServerCore::end_turn() {
  for (ServerRoom& room : rooms_) {
    if (!room.roster_changed) continue;
    room.roster_changed = false;
    for (const std::size_t member : room.members)
      if (sessions_[member].is_proven) send_roster(sessions_[member]);
  }
  while (!bundled_.empty()) flush_bundle(sessions_[bundled_.back()]);
}

MonoTime ServerCore::tick(MonoTime now) {
  for (std::size_t i = 0; i < sessions_.size(); ++i) {
    ServerSession& session = sessions_[i];
    const Duration limit = session.is_proven ? kSilenceLimit : kUnprovenLimit;
    if (!session.in_use || now - session.last_heard <= limit) continue;
    ++counters_.sessions_timed_out;
    drop_session(i);
  }
  end_turn();
  return by_id_.empty() ? MonoTime() : now + kTick;
}

void ServerCore::say_goodbye() {
  for (const ServerSession& session : sessions_) {
    if (!session.in_use) continue;
    std::array<std::uint8_t, wire::kSessionHeader> out;
    send(session.address, {out.data(), wire::build_bare(session.id, wire::Type::kGoodbye, out)});
  }
}

}  // namespace dance
