// Tap: a message type that only tests have, added as CONTRIBUTING.md says: its .lcm file
// (types/tap_t.lcm), its struct and its row; its fields are in tap.cpp, as those of ours in
// core/bus/encode.cpp. It travels on the channels of STYLE: the table of channels has none for it.
//
// Ownership: plain value.
// Threads:   none inside.
// Failure:   is_valid() is false for a force out of range.
#pragma once

#include "core/bus/encode.h"

namespace dance {

struct Tap {
  MonoTime time;
  std::uint64_t clock_id = 0;
  std::uint32_t count = 0;
  double force_n = 0.0;
  GuestId foot;
};
inline bool is_valid(const Tap& tap) { return tap.force_n >= 0.0 && tap.force_n <= 1000.0; }

template <>
struct MessageTraits<Tap> : MessageRow<Tap, Signal::kStyle> {};

inline Tap some_tap(std::uint32_t count = 3) {
  return {MonoTime::from_us(1'000'001), 77, count, 12.5, *GuestId::parse("left")};
}

}  // namespace dance
