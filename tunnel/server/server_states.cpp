// What changes seldom, at the server: kept while its guest, or the room, is there; told at once,
// and again with each pong until acknowledged.
#include <algorithm>

#include "core/base/assert.h"
#include "core/base/sequence.h"
#include "tunnel/server/server_core.h"

namespace dance {
namespace {

// Changes of a room go out this often at most; of what lies between, the newest.
constexpr Duration kFreshStatesPeriod = Duration::ms(20);
// To one link at once, and to all of a room together, lest poses that come meanwhile wait; what
// does not fit comes with the next pong.
constexpr std::size_t kFreshDatagrams = 4;
constexpr std::size_t kFreshDatagramsOfRoom = 64;

}  // namespace

void ServerCore::on_states(std::size_t session, wire::Bytes body, MonoTime now) {
  ByteReader in(body);
  ByteReader check = in;
  do {
    if (!wire::parse_state(check)) return reject(ServerReject::kMalformed);
  } while (check.remaining() > 0);
  // A state takes more bytes than its acknowledgement.
  std::array<std::uint8_t, wire::kMaxPlain> bytes;
  ByteWriter out(bytes);
  wire::begin_states(wire::Type::kStateAck, out);
  bool has_acks = false;
  while (in.remaining() > 0) {
    const wire::State state = *wire::parse_state(in);
    const auto ack = wire::is_of_room(state.name.kind) ? take_room_state(session, state, now)
                                                       : take_state(session, state, now);
    if (ack) wire::add_state_ack(*ack, out);
    has_acks = has_acks || ack.has_value();
  }
  DANCE_ASSERT(out.ok());
  if (has_acks) send(sessions_[session].peer, out.written());
}

void ServerCore::hold_state(ServerRoom& room, HeldState& held, const wire::State& state) {
  if (state.name.kind == wire::StateKind::kSkeleton && held.version == 0)
    room.has_first_body = true;
  held.version = state.version;
  held.size = static_cast<std::uint16_t>(state.payload.size());
  std::copy(state.payload.begin(), state.payload.end(), held.payload.begin());
  held.is_fresh = true;
  room.has_fresh_states = true;
  stir(room);
  ++counters_.states_in;
}

// What is too much now is not acknowledged: the link says its newest again with its next ping.
std::optional<wire::StateAck> ServerCore::take_state(std::size_t session, const wire::State& state,
                                                     MonoTime now) {
  ServerGuest* guest = guest_of(session, state.slot.slot);
  if (guest == nullptr) {
    reject(ServerReject::kForeignSlot);
    return std::nullopt;
  }
  HeldState& held = guest->states[wire::place_of(state.name)];
  if (held.version == 0 || is_newer_sequence(state.version, held.version)) {
    if (!guest->state_changes.take(1.0, now)) {
      reject(ServerReject::kStateRate);
      return std::nullopt;
    }
    hold_state(rooms_[sessions_[session].room], held, state);
  }
  return wire::StateAck{state.name, {state.slot.slot, guest->generation}, held.version, {}};
}

// The highest version wins, of equal ones the first; who comes second is told.
std::optional<wire::StateAck> ServerCore::take_room_state(std::size_t session,
                                                          const wire::State& state, MonoTime now) {
  const ServerSession& from = sessions_[session];
  ServerRoom& room = rooms_[from.room];
  const auto slot = std::find_if(from.slots.begin(), from.slots.end(),
                                 [&](std::uint8_t s) { return room.guests[s].id == state.setter; });
  if (slot == from.slots.end() || !may_set_room_state(from.access, room.has_host())) {
    reject(ServerReject::kNotAllowed);
    return wire::StateAck{state.name, {}, state.version, wire::StateVerdict::kNotAllowed};
  }
  const std::size_t place = wire::place_of(state.name);
  HeldState& held = room.states[place];
  if (held.version == 0 || is_newer_sequence(state.version, held.version)) {
    if (!room.guests[*slot].state_changes.take(1.0, now)) {
      reject(ServerReject::kStateRate);
      return std::nullopt;
    }
    hold_state(room, held, state);
    room.setters[place] = state.setter;
  } else if (held.version != state.version || room.setters[place] != state.setter) {
    reject(ServerReject::kOverruled);
    return wire::StateAck{state.name, {}, held.version, wire::StateVerdict::kOverruled};
  }
  return wire::StateAck{state.name, {}, held.version, wire::StateVerdict::kHeld};
}

void ServerCore::on_state_acks(std::size_t session, wire::Bytes body) {
  ByteReader in(body);
  ByteReader check = in;
  do {
    if (!wire::parse_state_ack(check)) return reject(ServerReject::kMalformed);
  } while (check.remaining() > 0);
  ServerSession& from = sessions_[session];
  const ServerRoom& room = rooms_[from.room];
  while (in.remaining() > 0) {
    const wire::StateAck ack = *wire::parse_state_ack(in);
    const std::size_t place = wire::place_of(ack.name);
    const ServerGuest& guest = room.guests[ack.slot.slot];
    if (wire::is_of_room(ack.name.kind))
      from.room_state_acked[place] = ack.version;
    else if (guest.in_use && guest.generation == ack.slot.generation)
      from.state_acked[ack.slot.slot][place] = ack.version;
  }
}

// Packs states into datagrams to one link, up to so many.
class ServerCore::StateSender {
 public:
  StateSender(ServerCore& core, PeerId to, std::size_t most_datagrams)
      : core_(core), to_(to), left_(most_datagrams) {}

  // False where there is no room for it any more.
  bool add(const wire::State& state) {
    if (out_.room() < wire::size_of(state)) flush();
    if (left_ == 0) return false;
    if (out_.size() == 0) wire::begin_states(wire::Type::kState, out_);
    wire::add_state(state, out_);
    DANCE_ASSERT(out_.ok());
    ++core_.counters_.states_out;
    return true;
  }
  void flush() {
    if (out_.size() == 0) return;
    core_.send(to_, out_.written());
    out_ = ByteWriter(bytes_);
    --left_;
  }

 private:
  ServerCore& core_;
  PeerId to_;
  std::size_t left_;
  std::array<std::uint8_t, wire::kMaxPlain> bytes_;
  ByteWriter out_{bytes_};
};

void ServerCore::send_states(std::size_t index, bool only_fresh, std::size_t most_datagrams) {
  ServerSession& session = sessions_[index];
  const ServerRoom& room = rooms_[session.room];
  StateSender sender(*this, session.peer, most_datagrams);
  const auto is_wanted = [&](const HeldState& held, std::uint32_t acked) {
    return held.version != 0 && held.version != acked && (held.is_fresh || !only_fresh);
  };
  bool has_room = true;
  // The room's also go to who set them: that is how the house knows that they hold.
  for (std::size_t place = 0; place < wire::kRoomStates && has_room; ++place) {
    const HeldState& held = room.states[place];
    if (is_wanted(held, session.room_state_acked[place]))
      has_room = sender.add(
          {wire::room_state_at(place), {}, room.setters[place], held.version, held.bytes()});
  }
  const std::size_t begin = session.state_cursor;
  for (std::size_t i = 0; i < room.guests.size() && has_room; ++i) {
    const std::size_t slot = (begin + i) % room.guests.size();
    const ServerGuest& guest = room.guests[slot];
    if (!guest.in_use || guest.owner == index) continue;
    const wire::Slot where{static_cast<std::uint8_t>(slot), guest.generation};
    for (std::size_t place = 0; place < wire::kGuestStates && has_room; ++place) {
      const HeldState& held = guest.states[place];
      if (is_wanted(held, session.state_acked[slot][place]))
        has_room =
            sender.add({wire::guest_state_at(place), where, GuestId(), held.version, held.bytes()});
    }
    if (!has_room) session.state_cursor = slot;
  }
  sender.flush();
}

void ServerCore::send_fresh_states(ServerRoom& room, MonoTime now) {
  const std::size_t most = std::clamp<std::size_t>(
      kFreshDatagramsOfRoom / std::max<std::size_t>(room.members.size(), 1), 1, kFreshDatagrams);
  for (const std::size_t member : room.members) send_states(member, true, most);
  for (HeldState& held : room.states) held.is_fresh = false;
  for (ServerGuest& guest : room.guests)
    for (HeldState& held : guest.states) held.is_fresh = false;
  room.has_fresh_states = room.has_first_body = false;
  room.fresh_states_due = now + kFreshStatesPeriod;
}

}  // namespace dance
