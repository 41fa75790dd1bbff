// What is a time in a file: the one check for readers of files that are not ours.
//
// Units/frames: microseconds of any clock, or since 1970.
// Ownership:    none.
// Threads:      none inside.
// Failure:      none.
#pragma once

#include <cstdint>

namespace dance {

// Within 100 years of its zero, as messages have it: sums and differences do not overflow.
inline bool is_recorded_time(std::int64_t us) {
  constexpr std::int64_t kMostSpan_us = 100LL * 366 * 24 * 3600 * 1'000'000;
  return us > -kMostSpan_us && us < kMostSpan_us;
}

}  // namespace dance
