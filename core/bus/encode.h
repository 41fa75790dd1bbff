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

#include "core/bus/messages.h"
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

enum class Decoded { kFine, kUndecodable, kInvalid };

Decoded decode(const void* data, std::size_t size, Pose& pose);
Decoded decode(const void* data, std::size_t size, Hands& hands);
Decoded decode(const void* data, std::size_t size, TimedSkeleton& skeleton);
Decoded decode(const void* data, std::size_t size, GuestStatus& status);
Decoded decode(const void* data, std::size_t size, Stats& stats);
Decoded decode(const void* data, std::size_t size, StageTime& stage_time);

}  // namespace dance
