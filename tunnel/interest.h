// Which guests a link wants to hear, and how often: a divider for each, and one for all others. What
// it makes of a guest's poses is decided by the server, so that what goes out can be decoded:
// few receivers who want less cost the others nothing, and need no key frames of their own.
//
// Units/frames: a divider: 0 = nothing of this guest, 1 = every pose, n = at most every n-th.
// Ownership:    plain values of fixed size, no allocation; parse_interest() is not for the pose path.
// Threads:      none inside.
// Failure:      parse_interest() names the word that is wrong and how it is written.
#pragma once

#include <bit>
#include <cstdint>
#include <span>
#include <string>

#include "core/base/result.h"
#include "tunnel/wire.h"

namespace dance {

// By name, as a house says it.
struct Interest {
  struct One {
    GuestId guest;
    std::uint8_t divider = 1;
    bool operator==(const One&) const = default;
  };
  std::uint8_t others = 1;  // who is not named
  FixedList<One, wire::kMaxGuestsPerRoom> guests;

  std::uint8_t divider_of(const GuestId& guest) const {
    for (const One& one : guests)
      if (one.guest == guest) return one.divider;
    return others;
  }
};

// "alice=1", "bob=0", "default=2": each at most once.
Result<Interest> parse_interest(std::span<const std::string> words);

// What of a guest's poses goes to a receiver with this divider.
enum class Share : std::uint8_t {
  kNone,
  kAll,
  kBase,    // frames that refer only to what all receivers have: each 2nd, 4th or 8th
  kStills,  // frames that need no other: each 16th to 128th, and no more than asked for
};
constexpr std::uint8_t kLargestBase = 8;
constexpr std::uint8_t kFewestStills_log2 = 7;  // one in 128 comes anyway
constexpr Share share_of(std::uint8_t divider) {
  if (divider == 0) return Share::kNone;
  if (divider == 1) return Share::kAll;
  return divider <= kLargestBase ? Share::kBase : Share::kStills;
}
// Each 2^n-th pose is near enough to each divider-th, and never more: 2 → 1, 3 → 2, 9 → 4.
// Powers of two, so that what goes to one receiver goes to those too who want more.
constexpr std::uint8_t spacing_log2(std::uint8_t divider) {
  const auto log2 = static_cast<std::uint8_t>(std::bit_width(static_cast<unsigned>(divider - 1)));
  return log2 < kFewestStills_log2 ? log2 : kFewestStills_log2;
}

}  // namespace dance
