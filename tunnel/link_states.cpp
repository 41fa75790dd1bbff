// What changes seldom, at the link: told until the server has it, and heard.
#include <algorithm>
#include <cmath>

#include "core/base/assert.h"
#include "core/base/sequence.h"
#include "core/bus/encode.h"
#include "tunnel/link_core.h"

namespace dance {
namespace {

constexpr std::size_t kMusicPlace = 0;
// What the music may be off by before the others are told again.
constexpr double kMusicTolerance_s = 0.003;
// Music that is said to be as far off as this is another wish, and not the same one in a clock that
// drifts.
constexpr double kSameMusic_s = 0.25;
constexpr Duration kLongestMusic = Duration::s(24 * 3600);

// As it travels: the time of saying it, and whose clock that was, are nobody's concern elsewhere.
template <class Message>
std::size_t encode_for_tunnel(Message message, MessageBuffer& buffer) {
  message.time = MonoTime();
  message.clock_id = 0;
  return encode(message, buffer);
}

template <class Message>
bool decode_from_tunnel(wire::Bytes payload, Message& message) {
  return decode(payload.data(), payload.size(), message) == Decoded::kFine;
}

bool is_same_music(const Music& a, const Music& b, MonoTime at, double tolerance_s) {
  if (a.title != b.title || a.tempo_bpm != b.tempo_bpm || a.beats_per_bar != b.beats_per_bar ||
      a.playing != b.playing)
    return false;
  return std::abs(a.beats_at(at) - b.beats_at(at)) * 60.0 / a.tempo_bpm <= tolerance_s;
}

}  // namespace

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

void LinkCore::send(const GuestId& id, const Music& given, MonoTime now) {
  if (!is_valid(given)) {
    ++counters_.states_invalid;
    return;
  }
  Music music = given;
  if (music.clock_id != options_.clock_id) {
    // As with poses of a clock that we do not know: taken as said now.
    ++counters_.foreign_clock;
    const Duration until = music.start_time - music.time;
    if (until < -kLongestMusic || until > kLongestMusic) {
      ++counters_.states_invalid;
      return;
    }
    music.start_time = now + until;
  }
  LocalGuest* guest = find_local(id);
  if (guest == nullptr || !clock_.is_mapped()) {
    ++counters_.unrouted;
    return;
  }
  const RoomWish& wish = wishes_[kMusicPlace];
  const bool is_again =
      guest->wished_music && is_same_music(music, *guest->wished_music, now, kSameMusic_s);
  guest->wished_music = music;
  // Overruled, saying the same again changes nothing.
  if (is_again && !(wish.is_alive && wish.setter == id)) return;
  wished_music_ = music;
  const MonoTime server_now = MonoTime::from_us(clock_.to_theirs_us(now));
  music.start_time = MonoTime::from_us(clock_.to_theirs_us(music.start_time));
  Music told;
  const wire::Bytes before = wish.state.bytes();
  if (is_again && decode_from_tunnel(before, told) &&
      is_same_music(music, told, server_now, kMusicTolerance_s))
    return;
  MessageBuffer buffer;
  const std::size_t size = encode_for_tunnel(music, buffer);
  make_wish(id, wire::StateKind::kMusic, {buffer.data(), size}, now);
}

void LinkCore::send(const GuestId& id, const Scene& scene, MonoTime now) {
  if (!is_valid(scene)) {
    ++counters_.states_invalid;
    return;
  }
  LocalGuest* guest = find_local(id);
  if (guest == nullptr) {
    ++counters_.unrouted;
    return;
  }
  Scene wished = scene;
  wished.time = MonoTime();
  wished.clock_id = 0;
  if (guest->wished_scene == wished) return;
  guest->wished_scene = wished;
  MessageBuffer buffer;
  const std::size_t size = encode_for_tunnel(scene, buffer);
  make_wish(id, wire::StateKind::kScene, {buffer.data(), size}, now);
}

void LinkCore::make_wish(const GuestId& setter, wire::StateKind kind, wire::Bytes payload,
                         MonoTime now) {
  const std::size_t place = wire::place_of({kind, 0});
  RoomWish& wish = wishes_[place];
  const std::uint32_t before = wish.state.version;
  if (!wish.state.set(payload) && wish.setter == setter) return;
  wish.setter = setter;
  wish.is_alive = true;
  wish.state.is_refused = false;
  // Above what holds; while that is not known, above what we said last.
  const std::uint32_t held = held_[place].version;
  wish.is_blind = held == 0;
  const std::uint32_t base =
      held != 0 && (before == 0 || is_newer_sequence(held, before)) ? held : before;
  wish.state.version = base + 1 == 0 ? 1 : base + 1;
  const LocalGuest* guest = find_local(setter);
  if (guest != nullptr && guest->has_slot && is_connected() && state_changes_.take(1.0, now))
    send_state({{kind, 0}, {}, setter, wish.state.version, wish.state.bytes()});
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

// A server that began anew has another clock.
void LinkCore::map_wished_music() {
  RoomWish& wish = wishes_[kMusicPlace];
  if (!wish.is_alive) return;
  Music music = wished_music_;
  music.start_time = MonoTime::from_us(clock_.to_theirs_us(music.start_time));
  MessageBuffer buffer;
  const std::size_t size = encode_for_tunnel(music, buffer);
  const std::uint32_t version = wish.state.version;
  wish.state.set({buffer.data(), size});
  wish.state.version = version;
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

bool LinkCore::on_room_state(const wire::State& state, MonoTime now) {
  const std::size_t place = wire::place_of(state.name);
  RoomHeld& held = held_[place];
  if (held.version != 0 && !is_newer_sequence(state.version, held.version)) return true;
  held.version = state.version;
  held.setter = state.setter;
  give_way(place, state.setter, state.version);
  bool is_good = false;
  if (state.name.kind == wire::StateKind::kMusic) {
    is_good = decode_from_tunnel(state.payload, held_music_);
    has_held_music_ = is_good;
    if (is_good && handlers_.on_music) handlers_.on_music(held.setter, *room_music(now), now);
  } else {
    is_good = deliver_message<Scene>(held.setter, state.payload, handlers_.on_scene, now);
  }
  ++(is_good ? counters_.states_delivered : counters_.states_invalid);
  return true;
}

std::optional<Music> LinkCore::room_music(MonoTime now) const {
  if (!has_held_music_) return std::nullopt;
  Music music = held_music_;
  music.time = now;
  music.clock_id = options_.clock_id;
  music.start_time = clock_.to_ours(held_music_.start_time.since_zero_us());
  return music;
}

// What holds now may not be what we wish.
void LinkCore::give_way(std::size_t place, const GuestId& setter, std::uint32_t version) {
  RoomWish& wish = wishes_[place];
  if (!wish.is_alive || (setter == wish.setter && version == wish.state.version)) return;
  if (is_newer_sequence(wish.state.version, version)) return;  // ours is under way
  if (wish.is_blind) {
    // Made before anybody told us that the room had one already.
    wish.is_blind = false;
    wish.state.version = version + 1 == 0 ? 1 : version + 1;
    return;
  }
  wish.is_alive = false;
  ++counters_.states_overruled;
  if (handlers_.on_room_state_refused)
    handlers_.on_room_state_refused(wire::room_state_at(place).kind,
                                    wire::StateVerdict::kOverruled);
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

void LinkCore::on_wish_ack(const wire::StateAck& ack) {
  const std::size_t place = wire::place_of(ack.name);
  RoomWish& wish = wishes_[place];
  if (!wish.is_alive) return;
  switch (ack.verdict) {
    case wire::StateVerdict::kHeld:
      if (ack.version != wish.state.version) return;
      wish.state.acked = ack.version;
      wish.is_blind = false;
      return;
    case wire::StateVerdict::kOverruled:
      return give_way(place, GuestId(), ack.version);
    case wire::StateVerdict::kNotAllowed:
      if (ack.version != wish.state.version || wish.state.is_refused) return;
      wish.state.is_refused = true;
      ++counters_.states_refused;
      if (handlers_.on_room_state_refused)
        handlers_.on_room_state_refused(ack.name.kind, ack.verdict);
      return;
  }
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
