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
#include <optional>
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
  kPoseIntraFrame = 1,
  kPose = 2,
  kHandsIntraFrame = 3,
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

// A packed pose or packed hands, still packed.
struct PackedMotion {
  bool is_pose = true;  // else hands
  bool is_key = false;
  std::string_view channel;  // its own
  std::uint32_t checksum = 0;
  std::span<const std::uint8_t> packed;
};

// nullopt of other events, of versions that are not known and of damage that shows here.
inline std::optional<PackedMotion> packed_motion_of(const LogEvent& event) {
  constexpr std::size_t kOpening_bytes = kPackedMagic.size() + 2 + 4;
  if (!is_packed(event) || event.data.size() < kOpening_bytes ||
      event.channel.size() == kPackedPrefix.size() ||
      event.data[kPackedMagic.size()] != kPackedVersion)
    return std::nullopt;
  const auto kind = static_cast<PackedKind>(event.data[kPackedMagic.size() + 1]);
  if (kind < PackedKind::kPoseIntraFrame || kind > PackedKind::kHands) return std::nullopt;
  PackedMotion motion;
  motion.is_pose = kind == PackedKind::kPoseIntraFrame || kind == PackedKind::kPose;
  motion.is_key = kind == PackedKind::kPoseIntraFrame || kind == PackedKind::kHandsIntraFrame;
  motion.channel = event.channel.substr(kPackedPrefix.size());
  for (std::size_t i = 4; i-- > 0;)
    motion.checksum = motion.checksum << 8 | event.data[kOpening_bytes - 4 + i];
  motion.packed = event.data.subspan(kOpening_bytes);
  return motion;
}

}  // namespace dance
