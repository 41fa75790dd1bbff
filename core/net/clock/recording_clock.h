// The times of a recording: the wall time at which it began, and from then on the monotonic clock.
// A wall clock that is set meanwhile leaves no gap in the recording and no time twice.
#pragma once

#include <chrono>

#include "core/base/time.h"
#include "core/net/mono_clock.h"

namespace dance {

// Microseconds since 1970.
inline std::int64_t wall_now_us() {
  return std::chrono::duration_cast<std::chrono::microseconds>(
             std::chrono::system_clock::now().time_since_epoch())
      .count();
}

class RecordingClock {
 public:
  // Begins now.
  RecordingClock() : RecordingClock(mono_now(), wall_now_us()) {}
  RecordingClock(MonoTime begin, std::int64_t wall_us)
      : wall_ahead_(Duration::us(wall_us) - (begin - MonoTime())) {}

  // Microseconds since 1970.
  std::int64_t wall_us(MonoTime now) const { return (now + wall_ahead_).since_zero_us(); }
  Duration wall_ahead() const { return wall_ahead_; }

 private:
  Duration wall_ahead_;
};

}  // namespace dance
