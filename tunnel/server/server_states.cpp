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
  const bool is_good = answer_states(
      body,
      [&](const wire::State& state) {
        return wire::is_of_room(state.name.kind) ? take_room_state(session, state, now)
                                                 : take_state(session, state, now);
      },
      [&](wire::Bytes answer) { send(sessions_[session].peer, answer); });
  if (!is_good) reject(ServerReject::kMalformed);
}

void ServerCore::hold_state(ServerRoom& room, RetainedState& held, const wire::State& state) {
  if (state.name.kind == wire::StateKind::kSkeleton && held.version == 0)
    room.has_first_body = true;
  held.set(state.version, state.payload);
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
  RetainedState& held = guest->states[wire::place_of(state.name)];
  if (held.is_newer(state.version)) {
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
  RetainedState& held = room.states[place];
  if (held.is_newer(state.version)) {
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
  ServerSession& from = sessions_[session];
  const ServerRoom& room = rooms_[from.room];
  const bool is_good = take_state_acks(body, [&](const wire::StateAck& ack) {
    const ServerGuest& guest = room.guests[ack.slot.slot];
    if (wire::is_of_room(ack.name.kind) ||
        (guest.in_use && guest.generation == ack.slot.generation))
      from.stream.states.take(ack);
  });
  if (!is_good) reject(ServerReject::kMalformed);
}

void ServerCore::send_states(std::size_t index, bool only_fresh, std::size_t most_datagrams) {
  ServerSession& session = sessions_[index];
  const ServerRoom& room = rooms_[session.room];
  StateWriter writer([&](wire::Bytes bytes) { send(session.peer, bytes); }, most_datagrams);
  // False where there is no room for it any more.
  const auto add = [&](const wire::StateName& name, const wire::Slot& slot, const GuestId& setter,
                       const RetainedState& state) {
    if (state.version == 0 || (only_fresh && !state.is_fresh) ||
        session.stream.states.has(name, slot.slot, state.version))
      return true;
    if (!writer.add({name, slot, setter, state.version, state.bytes()})) return false;
    ++counters_.states_out;
    return true;
  };
  bool has_room = true;
  // The room's also go to who set them: that is how the house knows that they hold.
  for (std::size_t place = 0; place < wire::kRoomStates && has_room; ++place)
    has_room = add(wire::room_state_at(place), {}, room.setters[place], room.states[place]);
  const std::size_t begin = session.state_cursor;
  for (std::size_t i = 0; i < room.guests.size() && has_room; ++i) {
    const std::size_t slot = (begin + i) % room.guests.size();
    const ServerGuest& guest = room.guests[slot];
    if (!guest.in_use || guest.owner == index) continue;
    const wire::Slot where{static_cast<std::uint8_t>(slot), guest.generation};
    for (std::size_t place = 0; place < wire::kGuestStates && has_room; ++place)
      has_room = add(wire::guest_state_at(place), where, {}, guest.states[place]);
    if (!has_room) session.state_cursor = slot;
  }
}

void ServerCore::send_fresh_states(ServerRoom& room, MonoTime now) {
  const std::size_t most = std::clamp<std::size_t>(
      kFreshDatagramsOfRoom / std::max<std::size_t>(room.members.size(), 1), 1, kFreshDatagrams);
  for (const std::size_t member : room.members) send_states(member, true, most);
  for (RetainedState& held : room.states) held.is_fresh = false;
  for (ServerGuest& guest : room.guests)
    for (RetainedState& held : guest.states) held.is_fresh = false;
  room.has_fresh_states = room.has_first_body = false;
  room.fresh_states_due = now + kFreshStatesPeriod;
}

}  // namespace dance
