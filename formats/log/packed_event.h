// A packed log is an LCM log with poses and hands encoded by the lossless codec: one event for one
// event, with its number and its time, on a channel without subscribers. This is the format of such
// an event; docs/codec.md#packed-logs has it byte by byte.
//
// Units/frames: bytes as in docs/codec.md.
// Ownership:    plain values.
// Threads:      none inside.
// Failure:      is_packed() is false for other events.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <string_view>

#include "formats/log/log_file.h"

namespace dance {

// In front of the channel's own name: no subscription to POSE/… matches it.
constexpr std::string_view kPackedPrefix = "PACKED/";
constexpr std::array<std::uint8_t, 3> kPackedMagic{'D', 'P', 'K'};
constexpr std::uint8_t kPackedVersion = 1;

enum class PackedKind : std::uint8_t {
  kAsItWas = 0,  // an event of the bus that looks packed: wrapped with its name
  // The others refer to the previous message of their channel.
  kPoseKeyFrame = 1,
  kPose = 2,
  kHandsKeyFrame = 3,
  kHands = 4,
};

// Most channels with state; beyond, the one that was silent for longest is evicted.
constexpr std::size_t kMaxMotionStreams = 256;

inline bool is_packed(const LogEvent& event) {
  return event.channel.starts_with(kPackedPrefix) && event.data.size() > kPackedMagic.size() &&
         std::equal(kPackedMagic.begin(), kPackedMagic.end(), event.data.begin());
}

// Of the plain message and its channel: 32-bit FNV-1a.
inline std::uint32_t checksum_of(std::string_view channel, std::span<const std::uint8_t> message) {
  std::uint32_t hash = 0x811c9dc5;
  for (const char c : channel) hash = (hash ^ static_cast<unsigned char>(c)) * 0x01000193;
  for (const std::uint8_t byte : message) hash = (hash ^ byte) * 0x01000193;
  return hash;
}

}  // namespace dance
