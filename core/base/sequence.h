// 32-bit sequence numbers that wrap: which is newer, and how many lie between.
//
// Units/frames: counts; a difference is right while it is below 2^31.
// Threads:      none inside.
// Failure:      none.
#pragma once

#include <cstdint>

namespace dance {

// How far b is ahead of a; negative when it is behind.
constexpr std::int32_t sequence_ahead(std::uint32_t a, std::uint32_t b) {
  return static_cast<std::int32_t>(b - a);
}
constexpr bool is_newer_sequence(std::uint32_t candidate, std::uint32_t reference) {
  return sequence_ahead(reference, candidate) > 0;
}

}  // namespace dance
