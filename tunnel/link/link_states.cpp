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
  ReplicatedState& state = guest->states[wire::place_of({kind, 0})];
  if (!state.change(payload) || !is_connected() || !guest->has_slot) return;
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
  StateWriter writer([this](wire::Bytes bytes) { send_datagram(bytes); });
  const auto add = [&](const wire::State& state) {
    writer.add(state);
    ++counters_.states_sent;
  };
  for (std::size_t place = 0; place < wire::kRoomStates; ++place) {
    const RoomWish& wish = wishes_[place];
    const LocalGuest* guest = wish.is_alive ? find_local(wish.setter) : nullptr;
    const wire::StateName name = wire::room_state_at(place);
    if (guest != nullptr && guest->has_slot && !wish.is_refused && is_due(wish.state, name, {}))
      add({name, {}, wish.setter, wish.state.version, wish.state.bytes()});
  }
  for (const LocalGuest& guest : locals_)
    for (std::size_t place = 0; guest.has_slot && place < guest.states.size(); ++place) {
      const ReplicatedState& state = guest.states[place];
      const wire::StateName name = wire::guest_state_at(place);
      if (is_due(state, name, guest.slot))
        add({name, guest.slot, {}, state.version, state.bytes()});
    }
  for (HouseChannel& channel : channels_)
    if (is_channel_due(channel, now))
      add({{wire::StateKind::kChannel, channel.index},
           channel.slot,
           {},
           channel.state.version,
           channel.state.bytes()});
}

// A new session: what holds there is not known yet.
void LinkCore::forget_room() {
  held_ = {};
  has_held_music_ = false;
}

bool LinkCore::on_states(wire::Bytes body, MonoTime now) {
  return answer_states(
      body,
      [&](const wire::State& state) -> std::optional<wire::StateAck> {
        if (wire::is_of_room(state.name.kind) ? !on_room_state(state, now)
                                              : !on_guest_state(state, now))
          return std::nullopt;
        return wire::StateAck{state.name, state.slot, state.version, wire::StateVerdict::kHeld};
      },
      [this](wire::Bytes answer) { send_datagram(answer); });
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
  return take_state_acks(body, [this](const wire::StateAck& ack) {
    if (wire::is_of_room(ack.name.kind)) return on_wish_ack(ack);
    const bool is_own = std::any_of(locals_.begin(), locals_.end(), [&](const LocalGuest& guest) {
      return guest.has_slot && guest.slot == ack.slot;
    });
    if (is_own) stream_.states.take(ack);
  });
}

}  // namespace dance
