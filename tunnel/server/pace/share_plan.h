// What a receiver's poses cost in bytes, and how little they have to wait or to be thinned out to
// stay within a budget. First the wait: poses that share a datagram share its headers. Where the
// longest wait does not do, a ramp: the least important guests come at a half, a quarter, an eighth
// of their rate, and as the ramp grows those before them, the most important last.
//
// Units/frames: bytes a second with all headers; dividers as in tunnel/policy/pose_share.h.
// Ownership:    plain values; never allocates.
// Threads:      none inside.
// Failure:      where even the whole ramp is too much it is that all the same: nobody is left out.
#pragma once

#include <cstdint>
#include <span>

#include "core/base/time.h"

namespace dance {

struct WantedFlow {
  double poses_per_s = 0.0;
  double bytes_per_s = 0.0;  // of records
  std::uint8_t divider = 1;  // as the receiver wants it; not 0
};

// The most important guest first.
using WantedFlows = std::span<const WantedFlow>;

constexpr Duration kLongestShareWindow = Duration::ms(4);

// The divider that a ramp leaves the guest at `place` of so many.
std::uint8_t ramp_divider(std::size_t place, std::size_t guests, std::size_t ramp);
// Beyond it everybody comes at an eighth.
std::size_t longest_ramp(std::size_t guests);

double share_cost(WantedFlows flows, std::size_t ramp, Duration window);
// The shortest wait that does; longer than kLongestShareWindow where none does.
Duration share_window_for(WantedFlows flows, std::size_t ramp, double bytes_per_s);
// The shortest ramp that does with the longest wait.
std::size_t ramp_for(WantedFlows flows, double bytes_per_s);
// The wait with which so many poses share a datagram on average.
Duration share_window_for_company(WantedFlows flows, std::size_t ramp, double poses_a_datagram);

}  // namespace dance
