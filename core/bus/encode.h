// This tree's types ⇄ the bytes of LCM messages: the one place that builds and reads generated
// types. What is decoded is checked here (finite, unit rotations, sizes) and trusted behind.
//
// Units/frames: as core/pose and core/bus/messages.h say.
// Ownership:    encodes into the caller's buffer; allocates nothing.
// Threads:      none inside.
// Failure:      decode() tells a message of another type or size (kUndecodable) from one with
//               impossible values (kInvalid).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "core/base/beat.h"
#include "core/bus/messages.h"
#include "core/bus/state_messages.h"
#include "core/pose/pose.h"

namespace dance {

// Room for any one of our messages.
constexpr std::size_t kMaxMessageBytes = 1024;
using MessageBuffer = std::array<std::uint8_t, kMaxMessageBytes>;

// Bytes written.
std::size_t encode(const Pose& pose, MessageBuffer& buffer);
std::size_t encode(const Hands& hands, MessageBuffer& buffer);
std::size_t encode(const TimedSkeleton& skeleton, MessageBuffer& buffer);
std::size_t encode(const GuestStatus& status, MessageBuffer& buffer);
std::size_t encode(const Stats& stats, MessageBuffer& buffer);
std::size_t encode(const StageTime& stage_time, MessageBuffer& buffer);
std::size_t encode(const Music& music, MessageBuffer& buffer);
std::size_t encode(const Scene& scene, MessageBuffer& buffer);
std::size_t encode(const Avatar& avatar, MessageBuffer& buffer);
std::size_t encode(const Style& style, MessageBuffer& buffer);
std::size_t encode(const Placement& placement, MessageBuffer& buffer);
std::size_t encode(const Beat& beat, MessageBuffer& buffer);

// A pose_t as it stands in a message, every bit of it and checked for nothing: for recordings,
// which give back what they were given. Whoever looks at poses wants decode().
struct RawPose {
  Pose pose;  // but its times, which may be more than MonoTime holds
  std::int64_t capture_time_us = 0;
  std::array<std::int64_t, kHopCount> hop_time_us{};
};
// As RawPose, of hands_t.
struct RawHands {
  Hands hands;
  std::int64_t capture_time_us = 0;
};
std::size_t encode(const RawPose& raw, MessageBuffer& buffer);
std::size_t encode(const RawHands& raw, MessageBuffer& buffer);
// False for another type or size.
bool decode_unchecked(const void* data, std::size_t size, RawPose& raw);
bool decode_unchecked(const void* data, std::size_t size, RawHands& raw);

enum class Decoded { kFine, kUndecodable, kInvalid };

Decoded decode(const void* data, std::size_t size, Pose& pose);
Decoded decode(const void* data, std::size_t size, Hands& hands);
Decoded decode(const void* data, std::size_t size, TimedSkeleton& skeleton);
Decoded decode(const void* data, std::size_t size, GuestStatus& status);
Decoded decode(const void* data, std::size_t size, Stats& stats);
Decoded decode(const void* data, std::size_t size, StageTime& stage_time);
Decoded decode(const void* data, std::size_t size, Music& music);
Decoded decode(const void* data, std::size_t size, Scene& scene);
Decoded decode(const void* data, std::size_t size, Avatar& avatar);
Decoded decode(const void* data, std::size_t size, Style& style);
Decoded decode(const void* data, std::size_t size, Placement& placement);
Decoded decode(const void* data, std::size_t size, Beat& beat);

}  // namespace dance
