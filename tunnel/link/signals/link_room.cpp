#include "tunnel/link/signals/link_room.h"

#include <cmath>

#include "core/base/sequence.h"
#include "tunnel/wire/state_bytes.h"

namespace dance {
namespace {

constexpr std::size_t kMusicPlace = 0;
// What the music may be off by before the others are told again.
constexpr double kMusicTolerance_s = 0.003;
// Music that is said to be as far off as this is another request, and not the same one in a clock
// that drifts.
constexpr double kSameMusic_s = 0.25;
constexpr Duration kLongestMusic = Duration::s(24 * 3600);

bool is_same_music(const Music& a, const Music& b, MonoTime at, double tolerance_s) {
  if (a.title != b.title || a.tempo_bpm != b.tempo_bpm || a.beats_per_bar != b.beats_per_bar ||
      a.playing != b.playing)
    return false;
  return std::abs(a.beats_at(at) - b.beats_at(at)) * 60.0 / a.tempo_bpm <= tolerance_s;
}

}  // namespace

void LinkRoom::send(const GuestId& id, const Music& given, MonoTime now) {
  if (!is_valid(given)) {
    ++link_.counters.states_invalid;
    return;
  }
  Music music = given;
  if (music.clock_id != link_.options.clock_id) {
    // As with poses of a clock that we do not know: taken as said now.
    ++link_.counters.foreign_clock;
    const Duration until = music.start_time - music.time;
    if (until < -kLongestMusic || until > kLongestMusic) {
      ++link_.counters.states_invalid;
      return;
    }
    music.start_time = now + until;
  }
  LocalGuest* guest = link_.locals.find(id);
  if (guest == nullptr || !link_.clock.is_mapped()) {
    ++link_.counters.unrouted;
    return;
  }
  const Request& request = requests_[kMusicPlace];
  const bool is_again =
      guest->requested_music && is_same_music(music, *guest->requested_music, now, kSameMusic_s);
  guest->requested_music = music;
  // Overruled, saying the same again changes nothing.
  if (is_again && !(request.is_open && request.setter == id)) return;
  requested_music_ = music;
  const MonoTime server_now = MonoTime::from_us(link_.clock.to_theirs_us(now));
  music.start_time = MonoTime::from_us(link_.clock.to_theirs_us(music.start_time));
  Music told;
  const wire::Bytes before = request.state.bytes();
  if (is_again && decode_from_tunnel(before, told) &&
      is_same_music(music, told, server_now, kMusicTolerance_s))
    return;
  MessageBuffer buffer;
  const std::size_t size = encode_for_tunnel(music, buffer);
  make_request(id, wire::StateKind::kMusic, {buffer.data(), size}, now);
}

void LinkRoom::send(const GuestId& id, const Scene& scene, MonoTime now) {
  if (!is_valid(scene)) {
    ++link_.counters.states_invalid;
    return;
  }
  LocalGuest* guest = link_.locals.find(id);
  if (guest == nullptr) {
    ++link_.counters.unrouted;
    return;
  }
  Scene requested = scene;
  requested.time = MonoTime();
  requested.clock_id = 0;
  if (guest->requested_scene == requested) return;
  guest->requested_scene = requested;
  MessageBuffer buffer;
  const std::size_t size = encode_for_tunnel(scene, buffer);
  make_request(id, wire::StateKind::kScene, {buffer.data(), size}, now);
}

void LinkRoom::make_request(const GuestId& setter, wire::StateKind kind, wire::Bytes payload,
                            MonoTime now) {
  const std::size_t place = wire::place_of({kind, 0});
  Request& request = requests_[place];
  const std::uint32_t before = request.state.version;
  if (!request.state.change(payload) && request.setter == setter) return;
  request.setter = setter;
  request.is_open = true;
  request.is_refused = false;
  // Above what holds; while that is not known, above what we said last.
  const std::uint32_t current = current_[place].version;
  request.is_blind = current == 0;
  const std::uint32_t base =
      current != 0 && (before == 0 || is_newer_sequence(current, before)) ? current : before;
  request.state.version = next_version(base);
  const LocalGuest* guest = link_.locals.find(setter);
  if (guest != nullptr && guest->has_slot && link_.is_connected() &&
      link_.state_changes.take(1.0, now))
    link_.send_state({{kind, 0}, {}, setter, request.state.version, request.state.bytes()});
}

// A server that began anew has another clock.
void LinkRoom::map_music() {
  Request& request = requests_[kMusicPlace];
  if (!request.is_open) return;
  Music music = requested_music_;
  music.start_time = MonoTime::from_us(link_.clock.to_theirs_us(music.start_time));
  MessageBuffer buffer;
  const std::size_t size = encode_for_tunnel(music, buffer);
  request.state.set(request.state.version, {buffer.data(), size});
}

bool LinkRoom::on_state(const wire::State& state, MonoTime now) {
  const std::size_t place = wire::place_of(state.name);
  Current& current = current_[place];
  if (current.version != 0 && !is_newer_sequence(state.version, current.version)) return true;
  current.version = state.version;
  current.setter = state.setter;
  yield_to(place, state.setter, state.version);
  bool is_good = false;
  if (state.name.kind == wire::StateKind::kMusic) {
    is_good = decode_from_tunnel(state.payload, current_music_);
    has_music_ = is_good;
    if (is_good && link_.handlers.on_music)
      link_.handlers.on_music(current.setter, *music(now), now);
  } else {
    Scene scene;
    is_good = decode_from_tunnel(state.payload, scene);
    scene.time = now;
    scene.clock_id = link_.options.clock_id;
    if (is_good && link_.handlers.on_scene) link_.handlers.on_scene(current.setter, scene, now);
  }
  ++(is_good ? link_.counters.states_delivered : link_.counters.states_invalid);
  return true;
}

void LinkRoom::begin_session() {
  current_ = {};
  has_music_ = false;
}

std::optional<Music> LinkRoom::music(MonoTime now) const {
  if (!has_music_) return std::nullopt;
  Music music = current_music_;
  music.time = now;
  music.clock_id = link_.options.clock_id;
  music.start_time = link_.clock.to_ours(current_music_.start_time.since_zero_us());
  return music;
}

// What holds now may not be what we request.
void LinkRoom::yield_to(std::size_t place, const GuestId& setter, std::uint32_t version) {
  Request& request = requests_[place];
  if (!request.is_open || (setter == request.setter && version == request.state.version)) return;
  if (is_newer_sequence(request.state.version, version)) return;  // ours is under way
  if (request.is_blind) {
    // Made before anybody told us that the room had one already.
    request.is_blind = false;
    request.state.version = next_version(version);
    return;
  }
  request.is_open = false;
  ++link_.counters.states_overruled;
  if (link_.handlers.on_room_state_refused)
    link_.handlers.on_room_state_refused(wire::room_state_at(place).kind,
                                         wire::StateVerdict::kOverruled);
}

void LinkRoom::on_ack(const wire::StateAck& ack) {
  const std::size_t place = wire::place_of(ack.name);
  Request& request = requests_[place];
  if (!request.is_open) return;
  switch (ack.verdict) {
    case wire::StateVerdict::kAccepted:
      if (ack.version != request.state.version) return;
      link_.stream.states.take(ack);
      request.is_blind = false;
      return;
    case wire::StateVerdict::kOverruled:
      return yield_to(place, GuestId(), ack.version);
    case wire::StateVerdict::kNotAllowed:
      if (ack.version != request.state.version || request.is_refused) return;
      request.is_refused = true;
      ++link_.counters.states_refused;
      if (link_.handlers.on_room_state_refused)
        link_.handlers.on_room_state_refused(ack.name.kind, ack.verdict);
      return;
  }
}

}  // namespace dance
