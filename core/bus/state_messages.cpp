#include "core/bus/state_messages.h"

#include <cmath>
#include <numbers>

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

bool is_plain_text(std::string_view text) {
  const auto byte = [&](std::size_t i) {
    return i < text.size() ? static_cast<unsigned char>(text[i]) : 0u;
  };
  for (std::size_t i = 0; i < text.size();) {
    const unsigned first = byte(i);
    if (first < 0x80) {
      if (first < 0x20 || first == 0x7f) return false;
      ++i;
      continue;
    }
    const std::size_t more = first >= 0xf0 ? 3 : first >= 0xe0 ? 2 : 1;
    if (first < 0xc2 || first > 0xf4) return false;
    std::uint32_t code = first & (0x3fu >> more);
    for (std::size_t k = 1; k <= more; ++k) {
      if ((byte(i + k) & 0xc0u) != 0x80u) return false;
      code = code << 6 | (byte(i + k) & 0x3fu);
    }
    constexpr std::uint32_t kLeast[] = {0, 0x80, 0x800, 0x10000};
    const bool is_surrogate = code >= 0xd800 && code < 0xe000;
    if (code < kLeast[more] || code > 0x10ffff || is_surrogate || code < 0xa0) return false;
    i += more + 1;
  }
  return true;
}

bool is_valid(const Music& music) {
  return is_within(music.start_beats, -1e7, 1e7) && is_within(music.tempo_bpm, 20.0, 400.0) &&
         is_within(music.beats_per_bar, 1, 16) && is_plain_text(music.title.view());
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

bool is_valid(const Placement& placement) {
  // A float next to pi may be above it.
  constexpr float kHalfTurn_rad = std::numbers::pi_v<float> + 1e-6f;
  return is_within(placement.x_m, -100.0f, 100.0f) && is_within(placement.z_m, -100.0f, 100.0f) &&
         is_within(placement.heading_rad, -kHalfTurn_rad, kHalfTurn_rad);
}

}  // namespace dance
