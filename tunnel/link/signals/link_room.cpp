#include "tunnel/link/signals/link_room.h"

#include <cmath>
#include <type_traits>

#include "core/base/sequence.h"
#include "tunnel/wire/state_bytes.h"

namespace dance {
namespace {

// An error of the start above this is corrected for the other houses.
constexpr double kStartTolerance_s = 0.003;
// A start that differs by more is another request, and not the same one in a clock that drifts.
constexpr double kSameStart_s = 0.25;
constexpr Duration kLongestMusic = Duration::s(24 * 3600);

template <class Message>
constexpr wire::StateKind kKindOf =
    std::is_same_v<Message, Music> ? wire::StateKind::kMusic : wire::StateKind::kSong;

bool is_same(const Music& a, const Music& b, MonoTime at, double tolerance_s) {
  if (a.title != b.title || a.tempo_bpm != b.tempo_bpm || a.beats_per_bar != b.beats_per_bar ||
      a.playing != b.playing)
    return false;
  return std::abs(a.beats_at(at) - b.beats_at(at)) * 60.0 / a.tempo_bpm <= tolerance_s;
}

bool is_same(const RoomSong& a, const RoomSong& b, MonoTime, double tolerance_s) {
  return is_same_song(a, b) && std::abs((a.start_time - b.start_time).as_seconds()) <= tolerance_s;
}

std::optional<Music>& requested_of(LocalGuest& guest, const Music&) {
  return guest.requested_music;
}
std::optional<RoomSong>& requested_of(LocalGuest& guest, const RoomSong&) {
  return guest.requested_song;
}

}  // namespace

void LinkRoom::send(const GuestId& id, const Music& music, MonoTime now) {
  send_timed(id, music, music_, now);
}

void LinkRoom::send(const GuestId& id, const RoomSong& song, MonoTime now) {
  send_timed(id, song, song_, now);
}

template <class Message>
void LinkRoom::send_timed(const GuestId& id, const Message& given, Timed<Message>& timed,
                          MonoTime now) {
  if (!is_valid(given)) {
    ++link_.counters.states_invalid;
    return;
  }
  Message message = given;
  if (message.clock_id != link_.options.clock_id) {
    // The clock is unknown, as it may be for poses: the message counts as published now.
    ++link_.counters.foreign_clock;
    const Duration until = message.start_time - message.time;
    if (until < -kLongestMusic || until > kLongestMusic) {
      ++link_.counters.states_invalid;
      return;
    }
    message.start_time = now + until;
  }
  LocalGuest* guest = link_.locals.find(id);
  if (guest == nullptr || !link_.clock.is_mapped()) {
    ++link_.counters.unrouted;
    return;
  }
  const Request& request = requests_[wire::place_of({kKindOf<Message>, 0})];
  std::optional<Message>& requested = requested_of(*guest, message);
  const bool is_again = requested && is_same(message, *requested, now, kSameStart_s);
  requested = message;
  // Overruled, the same request again changes nothing.
  if (is_again && !(request.is_open && request.setter == id)) return;
  timed.requested = message;
  const MonoTime server_now = MonoTime::from_us(link_.clock.to_theirs_us(now));
  message.start_time = MonoTime::from_us(link_.clock.to_theirs_us(message.start_time));
  Message sent;
  const wire::Bytes before = request.state.bytes();
  if (is_again && decode_from_tunnel(before, sent) &&
      is_same(message, sent, server_now, kStartTolerance_s))
    return;
  MessageBuffer buffer;
  const std::size_t size = encode_for_tunnel(message, buffer);
  make_request(id, kKindOf<Message>, {buffer.data(), size}, now);
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

void LinkRoom::map_times() {
  map_time(music_);
  map_time(song_);
}

template <class Message>
void LinkRoom::map_time(const Timed<Message>& timed) {
  Request& request = requests_[wire::place_of({kKindOf<Message>, 0})];
  if (!request.is_open) return;
  Message message = timed.requested;
  message.start_time = MonoTime::from_us(link_.clock.to_theirs_us(message.start_time));
  MessageBuffer buffer;
  const std::size_t size = encode_for_tunnel(message, buffer);
  request.state.set(request.state.version, {buffer.data(), size});
}

template <class Message, class Handler>
bool LinkRoom::deliver_timed(const wire::State& state, Timed<Message>& timed,
                             const Handler& handler, MonoTime now) {
  timed.is_known = decode_from_tunnel(state.payload, timed.current);
  if (timed.is_known && handler) handler(state.setter, *in_our_clock(timed, now), now);
  return timed.is_known;
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
    is_good = deliver_timed(state, music_, link_.handlers.on_music, now);
  } else if (state.name.kind == wire::StateKind::kSong) {
    is_good = deliver_timed(state, song_, link_.handlers.on_song, now);
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
  music_.is_known = song_.is_known = false;
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
