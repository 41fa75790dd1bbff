// What a link's interest (tunnel/policy/interest.h) makes of a guest's poses. It is decided by the
// server, so that what goes out can be decoded: few receivers who want less cost the others
// nothing, and need no intra frames of their own.
//
// Units/frames: a divider: 0 = nothing of this guest, 1 = every pose, n = at most every n-th.
// Ownership:    plain values, no allocation.
// Threads:      none inside.
// Failure:      none.
#pragma once

#include <bit>
#include <cstdint>

namespace dance {

// What of a guest's poses goes to a receiver with this divider.
enum class Share : std::uint8_t {
  kNone,
  kAll,
  kBase,   // frames that refer only to what all receivers have: each 2nd, 4th or 8th
  kIntra,  // intra frames: each 16th to 128th, and no more than asked for
};
constexpr std::uint8_t kLargestBase = 8;
constexpr std::uint8_t kFewestIntra_log2 = 7;  // one in 128 comes anyway
constexpr Share share_of(std::uint8_t divider) {
  if (divider == 0) return Share::kNone;
  if (divider == 1) return Share::kAll;
  return divider <= kLargestBase ? Share::kBase : Share::kIntra;
}
// Each 2^n-th pose is near enough to each divider-th, and never more: 2 → 1, 3 → 2, 9 → 4.
// Powers of two, so that what goes to one receiver goes to those too who want more.
constexpr std::uint8_t spacing_log2(std::uint8_t divider) {
  const auto log2 = static_cast<std::uint8_t>(std::bit_width(static_cast<unsigned>(divider - 1)));
  return log2 < kFewestIntra_log2 ? log2 : kFewestIntra_log2;
}

}  // namespace dance
