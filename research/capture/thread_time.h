// The processor time of the calling thread: what evaluations report, as other programs run beside.
//
// Units/frames: nanoseconds.
// Ownership:    plain function.
// Threads:      any.
// Failure:      0 where the system does not say it.
#pragma once

#include <time.h>

#include <cstdint>

namespace dance {

inline std::int64_t thread_time_ns() {
  timespec t{};
  if (clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t) != 0) return 0;
  return static_cast<std::int64_t>(t.tv_sec) * 1'000'000'000 + t.tv_nsec;
}

}  // namespace dance
