#include "tunnel/link/signals/link_states.h"

#include "core/base/sequence.h"
#include "tunnel/wire/state_bytes.h"

namespace dance {

// A state of a guest that has changed: at once, if there have not been too many.
void LinkStates::tell(LocalGuest& guest, wire::StateKind kind, const ReplicatedState& state,
                      MonoTime now) {
  if (kind == wire::StateKind::kAvatarFile && !link_.server_knows_files) return;
  if (link_.is_connected() && guest.has_slot && link_.state_changes.take(1.0, now))
    link_.send_state({{kind, 0}, guest.slot, {}, state.version, state.bytes()});
}

template <class Message>
void LinkStates::send(const GuestId& id, wire::StateKind kind, const Message& message,
                      MonoTime now) {
  if (!is_valid(message)) {
    ++link_.counters.states_invalid;
    return;
  }
  LocalGuest* guest = link_.locals.find(id);
  if (guest == nullptr) {
    ++link_.counters.unrouted;  // nobody of this name dances here yet; it is said again each second
    return;
  }
  MessageBuffer buffer;
  const std::size_t size = encode_for_tunnel(message, buffer);
  ReplicatedState& state = guest->states[wire::place_of({kind, 0})];
  if (state.change({buffer.data(), size})) tell(*guest, kind, state, now);
}
template void LinkStates::send(const GuestId&, wire::StateKind, const Avatar&, MonoTime);
template void LinkStates::send(const GuestId&, wire::StateKind, const AvatarFile&, MonoTime);
template void LinkStates::send(const GuestId&, wire::StateKind, const Style&, MonoTime);
template void LinkStates::send(const GuestId&, wire::StateKind, const Placement&, MonoTime);

void LinkStates::send(LocalGuest& guest, const Skeleton& skeleton, MonoTime now) {
  std::array<std::uint8_t, kSkeletonPayload> payload;
  const std::size_t size = encode_skeleton(skeleton, payload);
  if (size == 0) {
    ++link_.counters.invalid;
    return;
  }
  // Producers say it once a second: only a change is news.
  ReplicatedState& state = guest.states[wire::place_of({wire::StateKind::kSkeleton, 0})];
  if (!state.change({payload.data(), size})) return;
  // As the others get it: rounded.
  Skeleton rounded;
  if (guest.encoder && decode_skeleton(payload, rounded)) guest.encoder->set_skeleton(rounded);
  tell(guest, wire::StateKind::kSkeleton, state, now);
}

void LinkStates::send(const GuestId& id, const Chat& chat, MonoTime now) {
  LocalGuest* guest = link_.locals.find(id);
  if (guest == nullptr) {
    ++link_.counters.unrouted;
    return;
  }
  constexpr wire::StateName kName{wire::StateKind::kChat, 0};
  if (chat_.write(*guest, chat, now))
    tell(*guest, kName.kind, guest->states[wire::place_of(kName)], now);
}

void LinkStates::repeat(MonoTime now) {
  StateWriter writer([this](wire::Bytes bytes) { link_.send(bytes); });
  const auto add = [&](const wire::State& state) {
    writer.add(state);
    ++link_.counters.states_sent;
  };
  room_.each_due(add);
  for (const LocalGuest& guest : link_.locals)
    for (std::size_t place = 0; guest.has_slot && place < guest.states.size(); ++place) {
      const ReplicatedState& state = guest.states[place];
      const wire::StateName name = wire::guest_state_at(place);
      if (link_.is_due(state, name, guest.slot))
        add({name, guest.slot, {}, state.version, state.bytes()});
    }
  channels_.each_due(now, add);
}

bool LinkStates::on_states(wire::Bytes body, MonoTime now) {
  return answer_states(
      body,
      [&](const wire::State& state) -> std::optional<wire::StateAck> {
        if (wire::is_of_room(state.name.kind) ? !room_.on_state(state, now)
                                              : !on_guest_state(state, now))
          return std::nullopt;
        return wire::StateAck{state.name, state.slot, state.version, wire::StateVerdict::kAccepted};
      },
      [this](wire::Bytes answer) { link_.send(answer); });
}

bool LinkStates::on_acks(wire::Bytes body) {
  return take_state_acks(body, [this](const wire::StateAck& ack) {
    if (wire::is_of_room(ack.name.kind)) return room_.on_ack(ack);
    const LocalGuest* guest = link_.locals.find_slot(ack.slot.slot);
    if (guest != nullptr && guest->slot == ack.slot) link_.stream.states.take(ack);
  });
}

// False where it is to come again. Acknowledged even if damaged: asking again would bring the same.
bool LinkStates::on_guest_state(const wire::State& state, MonoTime now) {
  RemoteGuest& remote = link_.remotes[state.slot.slot];
  // Without its roster entry it means nothing.
  if (!remote.in_use || remote.is_ours || remote.generation != state.slot.generation) return false;
  std::uint32_t& version = remote.heard.state_versions[wire::place_of(state.name)];
  if (version != 0 && !is_newer_sequence(state.version, version)) return true;
  if (state.name.kind == wire::StateKind::kChannel) {
    if (!channels_.on_state(remote, state, now)) return false;
    version = state.version;
    return true;
  }
  version = state.version;
  if (deliver(remote, state, now)) {
    ++link_.counters.states_delivered;
  } else {
    ++link_.counters.states_invalid;
    ++remote.counts.invalid;
  }
  return true;
}

template <class Message, class Handler>
bool LinkStates::deliver_message(const GuestId& id, wire::Bytes payload, const Handler& handler,
                                 MonoTime now) {
  Message message;
  if (!decode_from_tunnel(payload, message)) return false;
  message.time = now;
  message.clock_id = link_.options.clock_id;
  if (handler) handler(id, message, now);
  return true;
}

bool LinkStates::deliver(RemoteGuest& remote, const wire::State& state, MonoTime now) {
  switch (state.name.kind) {
    case wire::StateKind::kSkeleton: {
      Skeleton skeleton;
      remote.has_skeleton = decode_skeleton(state.payload, skeleton);
      if (!remote.has_skeleton) return false;
      remote.skeleton = skeleton;
      remote.decoder->set_skeleton(skeleton);
      if (link_.handlers.on_skeleton) link_.handlers.on_skeleton(remote.id, skeleton, now);
      return true;
    }
    case wire::StateKind::kAvatar:
      return deliver_message<Avatar>(remote.id, state.payload, link_.handlers.on_avatar, now);
    case wire::StateKind::kAvatarFile:
      return deliver_message<AvatarFile>(remote.id, state.payload, link_.handlers.on_avatar_file,
                                         now);
    case wire::StateKind::kStyle:
      return deliver_message<Style>(remote.id, state.payload, link_.handlers.on_style, now);
    case wire::StateKind::kPlacement:
      return deliver_message<Placement>(remote.id, state.payload, link_.handlers.on_placement, now);
    case wire::StateKind::kChat:
      return chat_.deliver(remote.id, state.payload, now);
    case wire::StateKind::kMusic:
    case wire::StateKind::kScene:
    case wire::StateKind::kSong:
    case wire::StateKind::kChannel:
      break;
  }
  return false;
}

}  // namespace dance
