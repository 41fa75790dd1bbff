// How loud one guest's voice is to be, as people write it: "bob=0.5".
//
// Units/frames: a factor, 1 as it comes.
// Ownership:    plain values.
// Threads:      any.
// Failure:      parse_guest_volume() gives nullopt for anything but a guest's name, '=' and a
//               number from 0 to kLoudestVoice.
#pragma once

#include <charconv>
#include <optional>
#include <string_view>

#include "core/base/guest_id.h"

namespace dance {

constexpr double kLoudestVoice = 2.0;
constexpr const char* kGuestVolumeRule = "a volume is GUEST=0 to GUEST=2, as bob=0.5";

struct GuestVolume {
  GuestId guest;
  float volume = 1.0f;
};

inline std::optional<GuestVolume> parse_guest_volume(std::string_view text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string_view::npos) return std::nullopt;
  const auto guest = GuestId::parse(text.substr(0, equals));
  double volume = -1.0;
  const char* end = text.data() + text.size();
  const auto read = std::from_chars(text.data() + equals + 1, end, volume);
  if (!guest || read.ptr != end || !(volume >= 0.0 && volume <= kLoudestVoice)) return std::nullopt;
  return GuestVolume{*guest, static_cast<float>(volume)};
}

}  // namespace dance
