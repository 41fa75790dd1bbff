// The beginning of the year 2026 (UTC) on this machine's monotonic clock: synthetic dancers count
// from it, so that those of two machines are in step as exactly as the machines' wall clocks agree.
//
// Units/frames: MonoTime of this boot; before it, so negative.
// Threads:      any.
// Failure:      none; a wall clock that is set later has no effect on who has asked before.
#pragma once

#include <chrono>

#include "core/base/time.h"
#include "core/net/mono_clock.h"

namespace dance {

inline MonoTime calendar_zero() {
  using std::chrono::microseconds;
  constexpr std::chrono::sys_days kZero{std::chrono::year{2026} / 1 / 1};
  const auto since = std::chrono::system_clock::now() - kZero;
  return mono_now() - Duration::us(std::chrono::duration_cast<microseconds>(since).count());
}

}  // namespace dance
