#include "core/bus/state_messages.h"

#include <cmath>
#include <numbers>

#include "core/base/text/plain_text.h"

namespace dance {
namespace {

// False for what is not a number, too.
template <class T>
bool is_within(T value, T low, T high) {
  return value >= low && value <= high;
}

template <std::size_t kCount>
bool are_within(const std::array<float, kCount>& values, float low, float high) {
  for (const float value : values)
    if (!is_within(value, low, high)) return false;
  return true;
}

}  // namespace

bool is_valid(const Music& music) {
  return is_within(music.start_beats, -1e7, 1e7) && is_within(music.tempo_bpm, 20.0, 400.0) &&
         is_within(music.beats_per_bar, 1, 16) && is_plain_text(music.title.view());
}

bool is_valid(const RoomSong& song) {
  if (!is_within(song.style, 0, RoomSong::kStyles - 1) ||
      !is_within(song.start_beat, 0, RoomSong::kLastBeat) ||
      !is_within(song.tempo_count, 1, RoomSong::kMostTempi) || song.tempo_bar[0] != 0)
    return false;
  for (int i = 0; i < RoomSong::kMostTempi; ++i) {
    const auto at = static_cast<std::size_t>(i);
    const bool is_used = i < song.tempo_count;
    if (!is_within(song.tempo_centi_bpm[at], is_used ? 3000 : 0, is_used ? 40000 : 0) ||
        !is_within(song.tempo_bar[at], 0, is_used ? RoomSong::kLastBar : 0))
      return false;
    if (is_used && i > 0 && song.tempo_bar[at] <= song.tempo_bar[at - 1]) return false;
  }
  return true;
}

bool is_same_song(const RoomSong& a, const RoomSong& b) {
  return a.start_beat == b.start_beat && a.seed == b.seed && a.style == b.style &&
         a.playing == b.playing && a.locked == b.locked && a.tempo_count == b.tempo_count &&
         a.tempo_bar == b.tempo_bar && a.tempo_centi_bpm == b.tempo_centi_bpm;
}

bool is_valid(const Scene& scene) {
  return is_within(scene.floor_width_m, 1.0f, 200.0f) &&
         is_within(scene.floor_depth_m, 1.0f, 200.0f) && are_within(scene.light_rgb, 0.0f, 1.0f) &&
         is_within(scene.brightness, 0.0f, 1.0f) && is_within(scene.pulse, 0.0f, 1.0f);
}

bool is_valid(const Avatar& avatar) {
  return are_within(avatar.colour_rgb, 0.0f, 1.0f) && is_within(avatar.height_scale, 0.25f, 4.0f);
}

bool is_valid(const AvatarFile& file) {
  return is_within(file.size_bytes, file.hash.is_set() ? 1 : 0,
                   file.hash.is_set() ? kMaxAvatarFileBytes : 0) &&
         is_plain_text(file.name.view());
}

// The only check of a shown name between the network and the windows.
bool is_valid(const Profile& profile) {
  return profile.shown_name.empty() ||
         parse_shown_name(profile.shown_name.view()) == profile.shown_name;
}

bool is_valid(const Placement& placement) {
  // A float next to pi may be above it.
  constexpr float kHalfTurn_rad = std::numbers::pi_v<float> + 1e-6f;
  return is_within(placement.x_m, -100.0f, 100.0f) && is_within(placement.z_m, -100.0f, 100.0f) &&
         is_within(placement.heading_rad, -kHalfTurn_rad, kHalfTurn_rad);
}

}  // namespace dance
