#include <algorithm>
#include <dancelcm/avatar_t.hpp>
#include <dancelcm/beat_t.hpp>
#include <dancelcm/music_t.hpp>
#include <dancelcm/placement_t.hpp>
#include <dancelcm/scene_t.hpp>
#include <dancelcm/style_t.hpp>
#include <iterator>

#include "core/bus/message_bytes.h"

namespace dance {
namespace {

static_assert(std::size(decltype(dancelcm::style_t::gain){}) == kBodyZones);

template <std::size_t kBytes>
void put_text(std::string_view text, std::uint8_t (&bytes)[kBytes]) {
  DANCE_ASSERT(text.size() < kBytes, text.size());
  std::fill(std::copy(text.begin(), text.end(), bytes), std::end(bytes), std::uint8_t{0});
}

// What stands before the first 0; nullopt where there is none, or something stands behind it.
template <std::size_t kBytes>
std::optional<std::string_view> get_text(const std::uint8_t (&bytes)[kBytes]) {
  const auto* const end = std::find(std::begin(bytes), std::end(bytes), std::uint8_t{0});
  if (end == std::end(bytes)) return std::nullopt;
  if (std::any_of(end, std::end(bytes), [](std::uint8_t byte) { return byte != 0; }))
    return std::nullopt;
  return std::string_view(reinterpret_cast<const char*>(bytes),
                          static_cast<std::size_t>(end - std::begin(bytes)));
}

// A name, or none.
template <std::size_t kBytes>
bool get_name(const std::uint8_t (&bytes)[kBytes], GuestId& name) {
  const auto text = get_text(bytes);
  if (!text) return false;
  if (text->empty()) {
    name = GuestId();
    return true;
  }
  const auto parsed = GuestId::parse(*text);
  if (parsed) name = *parsed;
  return parsed.has_value();
}

template <class Value, class Message>
void put_stamp(const Value& value, Message& m) {
  m.time_us = to_us(value.time);
  m.clock_id = static_cast<std::int64_t>(value.clock_id);
}

template <class Message, class Value>
bool get_stamp(const Message& m, Value& value) {
  if (!is_time(m.time_us)) return false;
  value.time = from_us(m.time_us);
  value.clock_id = static_cast<std::uint64_t>(m.clock_id);
  return true;
}

template <class Value>
Decoded checked(bool is_good, const Value& read, Value& out) {
  if (!is_good || !is_valid(read)) return Decoded::kInvalid;
  out = read;
  return Decoded::kFine;
}

}  // namespace

std::size_t encode(const Music& music, MessageBuffer& buffer) {
  dancelcm::music_t m{};
  put_stamp(music, m);
  m.start_time_us = to_us(music.start_time);
  m.start_beats = music.start_beats;
  m.tempo_bpm = music.tempo_bpm;
  m.beats_per_bar = static_cast<std::int8_t>(music.beats_per_bar);
  m.playing = music.playing ? 1 : 0;
  put_text(music.title.view(), m.title);
  return pack(m, buffer);
}

Decoded decode(const void* data, std::size_t size, Music& music) {
  dancelcm::music_t m{};
  if (!unpack(data, size, m)) return Decoded::kUndecodable;
  Music read;
  const auto title = get_text(m.title);
  if (!title || !is_time(m.start_time_us) || !read.title.assign(*title)) return Decoded::kInvalid;
  read.start_time = from_us(m.start_time_us);
  read.start_beats = m.start_beats;
  read.tempo_bpm = m.tempo_bpm;
  read.beats_per_bar = m.beats_per_bar;
  read.playing = m.playing != 0;
  return checked(get_stamp(m, read), read, music);
}

std::size_t encode(const Scene& scene, MessageBuffer& buffer) {
  dancelcm::scene_t m{};
  put_stamp(scene, m);
  put_text(scene.name.view(), m.name);
  m.floor_width_m = scene.floor_width_m;
  m.floor_depth_m = scene.floor_depth_m;
  std::copy(scene.light_rgb.begin(), scene.light_rgb.end(), m.light_rgb);
  m.brightness = scene.brightness;
  m.pulse = scene.pulse;
  return pack(m, buffer);
}

Decoded decode(const void* data, std::size_t size, Scene& scene) {
  dancelcm::scene_t m{};
  if (!unpack(data, size, m)) return Decoded::kUndecodable;
  Scene read;
  read.floor_width_m = m.floor_width_m;
  read.floor_depth_m = m.floor_depth_m;
  std::copy(std::begin(m.light_rgb), std::end(m.light_rgb), read.light_rgb.begin());
  read.brightness = m.brightness;
  read.pulse = m.pulse;
  return checked(get_stamp(m, read) && get_name(m.name, read.name), read, scene);
}

std::size_t encode(const Avatar& avatar, MessageBuffer& buffer) {
  dancelcm::avatar_t m{};
  put_stamp(avatar, m);
  put_text(avatar.name.view(), m.name);
  std::copy(avatar.colour_rgb.begin(), avatar.colour_rgb.end(), m.colour_rgb);
  m.height_scale = avatar.height_scale;
  return pack(m, buffer);
}

Decoded decode(const void* data, std::size_t size, Avatar& avatar) {
  dancelcm::avatar_t m{};
  if (!unpack(data, size, m)) return Decoded::kUndecodable;
  Avatar read;
  std::copy(std::begin(m.colour_rgb), std::end(m.colour_rgb), read.colour_rgb.begin());
  read.height_scale = m.height_scale;
  return checked(get_stamp(m, read) && get_name(m.name, read.name), read, avatar);
}

std::size_t encode(const Style& style, MessageBuffer& buffer) {
  dancelcm::style_t m{};
  put_stamp(style, m);
  std::copy(style.gain.begin(), style.gain.end(), m.gain);
  m.periodic = style.periodic;
  m.dynamic = style.dynamic;
  return pack(m, buffer);
}

Decoded decode(const void* data, std::size_t size, Style& style) {
  dancelcm::style_t m{};
  if (!unpack(data, size, m)) return Decoded::kUndecodable;
  Style read;
  std::copy(std::begin(m.gain), std::end(m.gain), read.gain.begin());
  read.periodic = m.periodic;
  read.dynamic = m.dynamic;
  return checked(get_stamp(m, read), read, style);
}

std::size_t encode(const Placement& placement, MessageBuffer& buffer) {
  dancelcm::placement_t m{};
  put_stamp(placement, m);
  m.x_m = placement.x_m;
  m.z_m = placement.z_m;
  m.heading_rad = placement.heading_rad;
  return pack(m, buffer);
}

Decoded decode(const void* data, std::size_t size, Placement& placement) {
  dancelcm::placement_t m{};
  if (!unpack(data, size, m)) return Decoded::kUndecodable;
  Placement read;
  read.x_m = m.x_m;
  read.z_m = m.z_m;
  read.heading_rad = m.heading_rad;
  return checked(get_stamp(m, read), read, placement);
}

std::size_t encode(const Beat& beat, MessageBuffer& buffer) {
  dancelcm::beat_t m{};
  put_stamp(beat, m);
  m.beat_time_us = to_us(beat.beat_time);
  m.beat = beat.beat;
  m.tempo_bpm = beat.tempo_bpm;
  m.confidence = beat.confidence;
  m.beats_per_bar = static_cast<std::int8_t>(beat.beats_per_bar);
  m.playing = beat.playing ? 1 : 0;
  return pack(m, buffer);
}

Decoded decode(const void* data, std::size_t size, Beat& beat) {
  // A clock that is fed with a beat far ahead would believe in the music until then.
  constexpr std::int64_t kFarthestBeat_us = 60'000'000;
  dancelcm::beat_t m{};
  if (!unpack(data, size, m)) return Decoded::kUndecodable;
  Beat read;
  if (!is_time(m.beat_time_us) || !get_stamp(m, read)) return Decoded::kInvalid;
  const std::int64_t away_us = m.beat_time_us - m.time_us;
  read.beat_time = from_us(m.beat_time_us);
  read.beat = m.beat;
  read.tempo_bpm = m.tempo_bpm;
  read.confidence = m.confidence;
  read.beats_per_bar = m.beats_per_bar;
  read.playing = m.playing != 0;
  return checked(away_us <= kFarthestBeat_us && away_us >= -kFarthestBeat_us, read, beat);
}

}  // namespace dance
