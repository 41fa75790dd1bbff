// What a house wishes the room's music and scene to be, and what they are.
#include <cmath>

#include "core/base/sequence.h"
#include "tunnel/link/link_core.h"
#include "tunnel/wire/state_bytes.h"

namespace dance {
namespace {

constexpr std::size_t kMusicPlace = 0;
// What the music may be off by before the others are told again.
constexpr double kMusicTolerance_s = 0.003;
// Music that is said to be as far off as this is another wish, and not the same one in a clock that
// drifts.
constexpr double kSameMusic_s = 0.25;
constexpr Duration kLongestMusic = Duration::s(24 * 3600);

bool is_same_music(const Music& a, const Music& b, MonoTime at, double tolerance_s) {
  if (a.title != b.title || a.tempo_bpm != b.tempo_bpm || a.beats_per_bar != b.beats_per_bar ||
      a.playing != b.playing)
    return false;
  return std::abs(a.beats_at(at) - b.beats_at(at)) * 60.0 / a.tempo_bpm <= tolerance_s;
}

}  // namespace

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
  if (!wish.state.change(payload) && wish.setter == setter) return;
  wish.setter = setter;
  wish.is_alive = true;
  wish.is_refused = false;
  // Above what holds; while that is not known, above what we said last.
  const std::uint32_t held = held_[place].version;
  wish.is_blind = held == 0;
  const std::uint32_t base =
      held != 0 && (before == 0 || is_newer_sequence(held, before)) ? held : before;
  wish.state.version = next_version(base);
  const LocalGuest* guest = find_local(setter);
  if (guest != nullptr && guest->has_slot && is_connected() && state_changes_.take(1.0, now))
    send_state({{kind, 0}, {}, setter, wish.state.version, wish.state.bytes()});
}

// A server that began anew has another clock.
void LinkCore::map_wished_music() {
  RoomWish& wish = wishes_[kMusicPlace];
  if (!wish.is_alive) return;
  Music music = wished_music_;
  music.start_time = MonoTime::from_us(clock_.to_theirs_us(music.start_time));
  MessageBuffer buffer;
  const std::size_t size = encode_for_tunnel(music, buffer);
  wish.state.set(wish.state.version, {buffer.data(), size});
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
    Scene scene;
    is_good = decode_from_tunnel(state.payload, scene);
    scene.time = now;
    scene.clock_id = options_.clock_id;
    if (is_good && handlers_.on_scene) handlers_.on_scene(held.setter, scene, now);
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
    wish.state.version = next_version(version);
    return;
  }
  wish.is_alive = false;
  ++counters_.states_overruled;
  if (handlers_.on_room_state_refused)
    handlers_.on_room_state_refused(wire::room_state_at(place).kind,
                                    wire::StateVerdict::kOverruled);
}

void LinkCore::on_wish_ack(const wire::StateAck& ack) {
  const std::size_t place = wire::place_of(ack.name);
  RoomWish& wish = wishes_[place];
  if (!wish.is_alive) return;
  switch (ack.verdict) {
    case wire::StateVerdict::kHeld:
      if (ack.version != wish.state.version) return;
      stream_.states.take(ack);
      wish.is_blind = false;
      return;
    case wire::StateVerdict::kOverruled:
      return give_way(place, GuestId(), ack.version);
    case wire::StateVerdict::kNotAllowed:
      if (ack.version != wish.state.version || wish.is_refused) return;
      wish.is_refused = true;
      ++counters_.states_refused;
      if (handlers_.on_room_state_refused)
        handlers_.on_room_state_refused(ack.name.kind, ack.verdict);
      return;
  }
}

}  // namespace dance
