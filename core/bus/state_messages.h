// State: what changes rarely and has to be known by programs that start later: the room's music,
// song and scene; each guest's avatar, its file, style, placement and profile. The same fields as
// the .lcm files of lcmtypes, which document each, in this tree's types.
//
// Units/frames: MonoTime of the clock that clock_id names; metres and radians in W; music in beats.
// Ownership:    plain values, no heap.
// Threads:      none inside.
// Failure:      is_valid() is false for what the .lcm files do not allow.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "core/base/file_hash.h"
#include "core/base/fixed_string.h"
#include "core/base/guest_id.h"
#include "core/base/text/shown_name.h"
#include "core/base/time.h"
#include "core/signal/style.h"

namespace dance {

// Names of scenes and avatars follow the same rule as guest ids.
using SceneName = GuestId;
using AvatarName = GuestId;
using MusicTitle = FixedString<63>;

struct Music {
  MonoTime time;
  std::uint64_t clock_id = 0;
  MonoTime start_time;
  double start_beats = 0.0;
  double tempo_bpm = 120.0;
  int beats_per_bar = 4;
  bool playing = false;
  MusicTitle title;

  // Where the music stands at a time of the same clock.
  double beats_at(MonoTime t) const {
    return playing ? start_beats + (t - start_time).as_seconds() * tempo_bpm / 60.0 : start_beats;
  }
};

// The house band's song. Styles are numbered as in lcmtypes/song_t.lcm.
struct RoomSong {
  static constexpr int kStyles = 8;
  static constexpr int kMostTempi = 16;
  static constexpr std::int32_t kLastBar = 9999;
  static constexpr std::int32_t kLastBeat = 10'000'000;

  MonoTime time;
  std::uint64_t clock_id = 0;
  MonoTime start_time;          // of the first bar
  std::int32_t start_beat = 0;  // its first beat
  std::uint32_t seed = 0;
  int style = 0;
  bool playing = false;
  bool locked = false;
  int tempo_count = 1;
  std::array<std::int32_t, kMostTempi> tempo_bar{};
  std::array<std::int32_t, kMostTempi> tempo_centi_bpm{12000};
};

struct Scene {
  MonoTime time;
  std::uint64_t clock_id = 0;
  SceneName name;
  float floor_width_m = 8.0f;
  float floor_depth_m = 8.0f;
  std::array<float, 3> light_rgb{1.0f, 1.0f, 1.0f};
  float brightness = 1.0f;
  float pulse = 0.0f;
  bool operator==(const Scene&) const = default;
};

struct Avatar {
  MonoTime time;
  std::uint64_t clock_id = 0;
  AvatarName name;
  std::array<float, 3> colour_rgb{1.0f, 1.0f, 1.0f};
  float height_scale = 1.0f;
};

// Avatars for games and VR have 1 to 15 MB. At the usual rate this takes two minutes to travel, and
// a room of thirty usual ones fits into a server's memory.
constexpr std::int32_t kMaxAvatarFileBytes = 16 << 20;

struct AvatarFile {
  MonoTime time;
  std::uint64_t clock_id = 0;
  FileHash hash;  // not set: none
  std::int32_t size_bytes = 0;
  FixedString<63> name;
};

struct Placement {
  MonoTime time;
  std::uint64_t clock_id = 0;
  float x_m = 0.0f;
  float z_m = 0.0f;
  float heading_rad = 0.0f;
};

// Shown name and signs of a guest.
struct Profile {
  MonoTime time;
  std::uint64_t clock_id = 0;
  ShownName shown_name;  // "" = the guest's id is shown
  bool is_recording = false;
  bool is_host = false;
};

// Titles and names of files must be plain text (core/base/text/plain_text.h).
bool is_valid(const Music& music);
bool is_valid(const RoomSong& song);
// True if they differ only in their times.
bool is_same_song(const RoomSong& a, const RoomSong& b);
bool is_valid(const Scene& scene);
bool is_valid(const Avatar& avatar);
bool is_valid(const AvatarFile& file);
bool is_valid(const Placement& placement);
bool is_valid(const Profile& profile);

}  // namespace dance
