// What the server holds back of a receiver's poses just now, and from what it follows.
//
// Units/frames: MonoTime of the server's clock; guests by slot.
// Ownership:    plain value of fixed size.
// Threads:      none inside.
// Failure:      none.
#pragma once

#include <array>
#include <cstdint>

#include "tunnel/server/pace/line_budget.h"
#include "tunnel/wire/wire.h"

namespace dance {

struct SessionPace {
  LineBudget budget;
  Duration window;       // poses wait so long for others to share a datagram with
  std::size_t ramp = 0;  // tunnel/server/pace/share_plan.h
  std::array<std::uint8_t, wire::kMaxGuestsPerRoom> dividers;  // at least so much is left out
  double costs_more = 1.0;  // what went out, by what was reckoned
  MonoTime eased;           // when the ramp last became shorter
  // As it was at the last report.
  MonoTime reported;
  std::uint64_t bytes_out = 0, datagrams_out = 0, voice_bytes_out = 0, lost = 0, counted = 0;

  SessionPace() { dividers.fill(1); }
};

}  // namespace dance
