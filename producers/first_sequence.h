// The number that a producer's first pose bears: one that is started again leaps far above the
// numbers that it used before, 10,000 for each second, so that nobody takes its new poses for old
// ones, nor the leap for a loss.
//
// Threads: none inside.
// Failure: none; numbers wrap.
#pragma once

#include <cstdint>

#include "core/base/time.h"

namespace dance {

inline std::uint32_t first_sequence(MonoTime now) {
  return static_cast<std::uint32_t>(now.since_zero_us() / 100);
}

}  // namespace dance
