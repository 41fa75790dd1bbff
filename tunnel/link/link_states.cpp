// What changes seldom, at the link: told until the server has it, and heard.
#include <algorithm>

#include "core/base/assert.h"
#include "core/base/sequence.h"
#include "tunnel/link/link_core.h"
#include "tunnel/wire/state_bytes.h"

namespace dance {

LocalGuest* LinkCore::find_local(const GuestId& id) {
  const auto found =
      std::find_if(locals_.begin(), locals_.end(), [&](const auto& g) { return g.id == id; });
  return found == locals_.end() ? nullptr : &*found;
}

void LinkCore::tell(const GuestId& id, wire::StateKind kind, wire::Bytes payload, MonoTime now) {
  LocalGuest* guest = find_local(id);
  if (guest == nullptr) {
    ++counters_.unrouted;  // nobody of this name dances here yet; it is said again each second
    return;
  }
  OwnState& state = guest->states[wire::place_of({kind, 0})];
  if (!state.set(payload) || !is_connected() || !guest->has_slot) return;
  if (state_changes_.take(1.0, now))
    send_state({{kind, 0}, guest->slot, {}, state.version, state.bytes()});
}

template <class Message>
void LinkCore::tell_message(const GuestId& id, wire::StateKind kind, const Message& message,
                            MonoTime now) {
  if (!is_valid(message)) {
    ++counters_.states_invalid;
    return;
  }
  MessageBuffer buffer;
  const std::size_t size = encode_for_tunnel(message, buffer);
  tell(id, kind, {buffer.data(), size}, now);
}

void LinkCore::send(const GuestId& id, const Avatar& avatar, MonoTime now) {
  tell_message(id, wire::StateKind::kAvatar, avatar, now);
}
void LinkCore::send(const GuestId& id, const Style& style, MonoTime now) {
  tell_message(id, wire::StateKind::kStyle, style, now);
}
void LinkCore::send(const GuestId& id, const Placement& placement, MonoTime now) {
  tell_message(id, wire::StateKind::kPlacement, placement, now);
}

void LinkCore::send_state(const wire::State& state) {
  std::array<std::uint8_t, wire::kMaxPlain> bytes;
  ByteWriter out(bytes);
  wire::begin_states(wire::Type::kState, out);
  wire::add_state(state, out);
  DANCE_ASSERT(out.ok());
  ++counters_.states_sent;
  send_datagram(out.written());
}

// With each ping: what the server has not acknowledged.
void LinkCore::repeat_states(MonoTime now) {
  std::array<std::uint8_t, wire::kMaxPlain> bytes;
  ByteWriter out(bytes);
  const auto add = [&](const wire::State& state) {
    if (out.room() < wire::size_of(state)) {
      send_datagram(out.written());
      out = ByteWriter(bytes);
    }
    if (out.size() == 0) wire::begin_states(wire::Type::kState, out);
    wire::add_state(state, out);
    ++counters_.states_sent;
  };
  for (std::size_t place = 0; place < wire::kRoomStates; ++place) {
    const RoomWish& wish = wishes_[place];
    const LocalGuest* guest = wish.is_alive ? find_local(wish.setter) : nullptr;
    if (guest != nullptr && guest->has_slot && wish.state.is_due())
      add({wire::room_state_at(place), {}, wish.setter, wish.state.version, wish.state.bytes()});
  }
  for (const LocalGuest& guest : locals_)
    for (std::size_t place = 0; guest.has_slot && place < guest.states.size(); ++place)
      if (const OwnState& state = guest.states[place]; state.is_due())
        add({wire::guest_state_at(place), guest.slot, {}, state.version, state.bytes()});
  for (HouseChannel& channel : channels_)
    if (is_channel_due(channel, now))
      add({{wire::StateKind::kChannel, channel.index},
           channel.slot,
           {},
           channel.state.version,
           channel.state.bytes()});
  if (out.size() > 0) send_datagram(out.written());
}

// A new session: what was acknowledged there is not known here.
void LinkCore::forget_acks() {
  for (std::size_t place = 0; place < wire::kRoomStates; ++place) {
    wishes_[place].state.acked = 0;
    held_[place] = RoomHeld();
  }
  has_held_music_ = false;
  for (HouseChannel& channel : channels_) channel.state.acked = 0;
}

bool LinkCore::on_states(wire::Bytes body, MonoTime now) {
  ByteReader in(body);
  ByteReader check = in;
  do {
    if (!wire::parse_state(check)) return false;
  } while (check.remaining() > 0);
  std::array<std::uint8_t, wire::kMaxPlain> bytes;
  ByteWriter out(bytes);
  wire::begin_states(wire::Type::kStateAck, out);
  bool has_acks = false;
  while (in.remaining() > 0) {
    const wire::State state = *wire::parse_state(in);
    const bool is_taken =
        wire::is_of_room(state.name.kind) ? on_room_state(state, now) : on_guest_state(state, now);
    if (!is_taken) continue;
    wire::add_state_ack({state.name, state.slot, state.version, wire::StateVerdict::kHeld}, out);
    has_acks = true;
  }
  DANCE_ASSERT(out.ok());
  if (has_acks) send_datagram(out.written());
  return true;
}

// False where it is to come again. Acknowledged even if damaged: asking again would bring the same.
bool LinkCore::on_guest_state(const wire::State& state, MonoTime now) {
  RemoteGuest& remote = remotes_[state.slot.slot];
  // Without its roster entry it means nothing.
  if (!remote.in_use || remote.is_ours || remote.generation != state.slot.generation) return false;
  std::uint32_t& version = remote.state_versions[wire::place_of(state.name)];
  if (version != 0 && !is_newer_sequence(state.version, version)) return true;
  if (state.name.kind == wire::StateKind::kChannel) {
    if (!on_channel_state(remote, state, now)) return false;
    version = state.version;
    return true;
  }
  version = state.version;
  if (deliver_guest_state(remote, state, now)) {
    ++counters_.states_delivered;
  } else {
    ++counters_.states_invalid;
    ++remote.invalid;
  }
  return true;
}

template <class Message, class Handler>
bool LinkCore::deliver_message(const GuestId& id, wire::Bytes payload, const Handler& handler,
                               MonoTime now) {
  Message message;
  if (!decode_from_tunnel(payload, message)) return false;
  message.time = now;
  message.clock_id = options_.clock_id;
  if (handler) handler(id, message, now);
  return true;
}

bool LinkCore::deliver_guest_state(RemoteGuest& remote, const wire::State& state, MonoTime now) {
  switch (state.name.kind) {
    case wire::StateKind::kSkeleton: {
      Skeleton skeleton;
      remote.has_skeleton = decode_skeleton(state.payload, skeleton);
      if (!remote.has_skeleton) return false;
      remote.skeleton = skeleton;
      remote.decoder->set_skeleton(skeleton);
      if (handlers_.on_skeleton) handlers_.on_skeleton(remote.id, skeleton, now);
      return true;
    }
    case wire::StateKind::kAvatar:
      return deliver_message<Avatar>(remote.id, state.payload, handlers_.on_avatar, now);
    case wire::StateKind::kStyle:
      return deliver_message<Style>(remote.id, state.payload, handlers_.on_style, now);
    case wire::StateKind::kPlacement:
      return deliver_message<Placement>(remote.id, state.payload, handlers_.on_placement, now);
    case wire::StateKind::kMusic:
    case wire::StateKind::kScene:
    case wire::StateKind::kChannel:
      break;
  }
  return false;
}

bool LinkCore::on_state_acks(wire::Bytes body) {
  ByteReader in(body);
  ByteReader check = in;
  do {
    if (!wire::parse_state_ack(check)) return false;
  } while (check.remaining() > 0);
  while (in.remaining() > 0) {
    const wire::StateAck ack = *wire::parse_state_ack(in);
    if (wire::is_of_room(ack.name.kind))
      on_wish_ack(ack);
    else
      on_guest_state_ack(ack);
  }
  return true;
}

void LinkCore::on_guest_state_ack(const wire::StateAck& ack) {
  if (ack.name.kind == wire::StateKind::kChannel) {
    for (HouseChannel& channel : channels_)
      if (channel.is_bound && channel.slot.slot == ack.slot.slot &&
          channel.slot.generation == ack.slot.generation && channel.index == ack.name.index)
        channel.state.acked = ack.version;
    return;
  }
  for (LocalGuest& guest : locals_)
    if (guest.has_slot && guest.slot.slot == ack.slot.slot &&
        guest.slot.generation == ack.slot.generation)
      guest.states[wire::place_of(ack.name)].acked = ack.version;
}

}  // namespace dance
