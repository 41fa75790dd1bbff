#include "tunnel/server/signals/server_states.h"

#include <algorithm>

#include "tunnel/wire/state_bytes.h"
#include "tunnel/wire/wire_chat.h"

namespace dance {
namespace {

// Changes of a room go out this often at most; of what lies between, the newest.
constexpr Duration kFreshStatesPeriod = Duration::ms(20);
// To one link at once, and to all of a room together, lest poses that come meanwhile wait; what
// does not fit comes with the next pong.
constexpr std::size_t kFreshDatagrams = 4;
constexpr std::size_t kFreshDatagramsOfRoom = 64;

// A song names by itself whether only hosts may change it.
bool may_set(const Access& access, const ServerRoom& room, const wire::State& state) {
  if (state.name.kind != wire::StateKind::kSong) return may_set_room_state(access, room.has_host());
  RoomSong song, in_force;
  if (!decode_from_tunnel(state.payload, song)) return false;
  const RetainedState& retained = room.states[wire::place_of(state.name)];
  const bool is_locked =
      retained.version != 0 && decode_from_tunnel(retained.bytes(), in_force) && in_force.locked;
  // A guest's song keeps the lock of a host who has left.
  return may_set_song(access, is_locked && room.has_host(), song.locked && !is_locked);
}

}  // namespace

void ServerStates::on_states(std::size_t session, wire::Bytes body, MonoTime now) {
  const bool is_good = answer_states(
      body,
      [&](const wire::State& state) {
        return wire::is_of_room(state.name.kind) ? take_of_room(session, state, now)
                                                 : take(session, state, now);
      },
      [&](wire::Bytes answer) { server_.send(server_.sessions[session].peer, answer); });
  if (!is_good) server_.reject(ServerReject::kMalformed);
}

void ServerStates::retain(ServerRoom& room, RetainedState& retained, const wire::State& state) {
  if (state.name.kind == wire::StateKind::kSkeleton && retained.version == 0)
    room.has_first_body = true;
  retained.set(state.version, state.payload);
  retained.is_fresh = true;
  room.has_fresh_states = true;
  server_.mark_changed(room);
  ++server_.counters.states_in;
}

// Lines and signs that the server has not forwarded yet are charged to the guest's budget. A
// history whose sequence goes back is refused: going back and forth would bypass the limit.
bool ServerStates::accept_chat(ServerGuest& guest, const RetainedState& retained,
                               wire::Bytes payload, MonoTime now) {
  const auto history = wire::parse_chat(payload), before = wire::parse_chat(retained.bytes());
  if (!history) {
    server_.reject(ServerReject::kMalformed);
    return false;
  }
  const std::size_t size = history->entries.size();
  const std::size_t count = before ? history->count_new(before->sequence) : size;
  const bool is_repeated =
      before && history->sequence == before->sequence && size <= before->entries.size();
  if (count == 0 && !is_repeated) {
    server_.reject(ServerReject::kMalformed);
    return false;
  }
  std::size_t lines = 0;
  for (std::size_t i = size - count; i < size; ++i) lines += history->entries[i].is_line() ? 1 : 0;
  if (guest.chat.take(lines, count - lines, now)) return true;
  server_.reject(ServerReject::kChatRate);
  return false;
}

// The server paces poses by the guests' placements (tunnel/server/signals/server_pace.h).
void ServerStates::note_place(ServerGuest& guest, const wire::State& state) {
  Placement placement;
  if (state.name.kind == wire::StateKind::kPlacement &&
      decode_from_tunnel(state.payload, placement))
    guest.place = {placement.x_m, placement.z_m};
}

// Of a room's state two servers may each have taken one of the same version; which of them holds is
// settled for all servers alike by who stands between them, and who was told the other hears again.
void ServerStates::on_remote_state(ServerRoom& room, ServerGuest* guest, const wire::State& state) {
  const std::size_t place = wire::place_of(state.name);
  RetainedState& retained = guest != nullptr ? guest->states[place] : room.states[place];
  const bool is_other =
      guest == nullptr && retained.version == state.version && room.setters[place] != state.setter;
  if (!retained.is_newer(state.version) && !is_other) return;
  if (is_other)
    for (const std::size_t member : room.members)
      server_.sessions[member].stream.states.forget(state.name, 0);
  if (guest == nullptr) room.setters[place] = state.setter;
  if (guest != nullptr) note_place(*guest, state);
  retain(room, retained, state);
}

// What is too much now is not acknowledged: the link says its newest again with its next ping.
std::optional<wire::StateAck> ServerStates::take(std::size_t session, const wire::State& state,
                                                 MonoTime now) {
  ServerGuest* guest = server_.guest_of(session, state.slot.slot);
  if (guest == nullptr) {
    server_.reject(ServerReject::kForeignSlot);
    return std::nullopt;
  }
  RetainedState& retained = guest->states[wire::place_of(state.name)];
  if (retained.is_newer(state.version)) {
    if (!guest->state_changes.take(1.0, now)) {
      server_.reject(ServerReject::kStateRate);
      return std::nullopt;
    }
    if (state.name.kind == wire::StateKind::kChat &&
        !accept_chat(*guest, retained, state.payload, now))
      return std::nullopt;
    const ServerRoom& room = server_.rooms[server_.sessions[session].room];
    retain(server_.rooms[server_.sessions[session].room], retained, state);
    note_place(*guest, state);
    if (server_.cluster != nullptr) server_.cluster->on_state(room, guest, state);
  }
  return wire::StateAck{state.name, {state.slot.slot, guest->generation}, retained.version, {}};
}

// The highest version wins, of equal ones the first; the second sender is told.
std::optional<wire::StateAck> ServerStates::take_of_room(std::size_t session,
                                                         const wire::State& state, MonoTime now) {
  const ServerSession& from = server_.sessions[session];
  ServerRoom& room = server_.rooms[from.room];
  const auto slot = std::find_if(from.slots.begin(), from.slots.end(),
                                 [&](std::uint8_t s) { return room.guests[s].id == state.setter; });
  if (slot == from.slots.end() || !may_set(from.access, room, state)) {
    server_.reject(ServerReject::kNotAllowed);
    return wire::StateAck{state.name, {}, state.version, wire::StateVerdict::kNotAllowed};
  }
  const std::size_t place = wire::place_of(state.name);
  RetainedState& retained = room.states[place];
  if (retained.is_newer(state.version)) {
    if (!room.guests[*slot].state_changes.take(1.0, now)) {
      server_.reject(ServerReject::kStateRate);
      return std::nullopt;
    }
    retain(room, retained, state);
    room.setters[place] = state.setter;
    if (server_.cluster != nullptr) server_.cluster->on_state(room, nullptr, state);
  } else if (retained.version != state.version || room.setters[place] != state.setter) {
    server_.reject(ServerReject::kOverruled);
    return wire::StateAck{state.name, {}, retained.version, wire::StateVerdict::kOverruled};
  }
  return wire::StateAck{state.name, {}, retained.version, wire::StateVerdict::kAccepted};
}

void ServerStates::on_acks(std::size_t session, wire::Bytes body) {
  ServerSession& from = server_.sessions[session];
  const ServerRoom& room = server_.rooms[from.room];
  const bool is_good = take_state_acks(body, [&](const wire::StateAck& ack) {
    const ServerGuest& guest = room.guests[ack.slot.slot];
    if (wire::is_of_room(ack.name.kind) ||
        (guest.in_use && guest.generation == ack.slot.generation))
      from.stream.states.take(ack);
  });
  if (!is_good) server_.reject(ServerReject::kMalformed);
}

void ServerStates::send(std::size_t index, bool only_fresh, std::size_t most_datagrams) {
  ServerSession& session = server_.sessions[index];
  const ServerRoom& room = server_.rooms[session.room];
  StateWriter writer([&](wire::Bytes bytes) { server_.send(session.peer, bytes); }, most_datagrams);
  // False where there is no room for it any more.
  const auto add = [&](const wire::StateName& name, const wire::Slot& slot, const GuestId& setter,
                       const RetainedState& state) {
    if (state.version == 0 || (only_fresh && !state.is_fresh) ||
        (name.kind == wire::StateKind::kAvatarFile && !session.knows_files()) ||
        session.stream.states.has(name, slot.slot, state.version))
      return true;
    if (!writer.add({name, slot, setter, state.version, state.bytes()})) return false;
    ++server_.counters.states_out;
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

void ServerStates::send_fresh(ServerRoom& room, MonoTime now) {
  const std::size_t most = std::clamp<std::size_t>(
      kFreshDatagramsOfRoom / std::max<std::size_t>(room.link_count(), 1), 1, kFreshDatagrams);
  for (const std::size_t member : room.members)
    if (!server_.sessions[member].is_remote()) send(member, true, most);
  for (RetainedState& retained : room.states) retained.is_fresh = false;
  for (ServerGuest& guest : room.guests)
    for (RetainedState& retained : guest.states) retained.is_fresh = false;
  room.has_fresh_states = room.has_first_body = false;
  room.fresh_states_due = now + kFreshStatesPeriod;
}

}  // namespace dance
