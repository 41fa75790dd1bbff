// The profile of a guest as it travels to the other houses: a byte of signs, then the shown name to
// the end. It is the message of a further channel of class state, NAMES/<guest>, so that servers
// and older links forward it without support for it.
//
// Failure: parse_profile() returns nullopt for bytes that are too many or no shown name.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "core/bus/state_messages.h"

namespace dance {

// The channel's name before the guest's id.
constexpr std::string_view kProfilePrefix = "NAMES/";
constexpr std::size_t kMaxProfileBytes = 1 + kMaxShownNameBytes;
// The other bits are 0; a receiver ignores them.
constexpr std::uint8_t kProfileRecords = 1, kProfileHosts = 2;
using ProfileBytes = std::array<std::uint8_t, kMaxProfileBytes>;

// The number of bytes written.
inline std::size_t write_profile(const Profile& profile, ProfileBytes& out) {
  out[0] = static_cast<std::uint8_t>((profile.is_recording ? kProfileRecords : 0) |
                                     (profile.is_host ? kProfileHosts : 0));
  const std::string_view name = profile.shown_name.view();
  std::copy(name.begin(), name.end(), out.begin() + 1);
  return 1 + name.size();
}

inline std::optional<Profile> parse_profile(std::span<const std::uint8_t> bytes) {
  if (bytes.empty() || bytes.size() > kMaxProfileBytes) return std::nullopt;
  Profile profile;
  profile.is_recording = (bytes[0] & kProfileRecords) != 0;
  profile.is_host = (bytes[0] & kProfileHosts) != 0;
  const auto name = bytes.subspan(1);
  if (!profile.shown_name.assign({reinterpret_cast<const char*>(name.data()), name.size()}) ||
      !is_valid(profile))
    return std::nullopt;
  return profile;
}

}  // namespace dance
