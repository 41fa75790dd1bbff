// The beginning of the year 2026 (UTC) on this machine's monotonic clock: synthetic dancers count
// from it, so that dancers on two machines are in step as exactly as the wall clocks agree.
//
// Units/frames: MonoTime of this boot; before it, so negative.
// Threads:      any.
// Failure:      none; setting the wall clock later does not change a zero that was read before.
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
