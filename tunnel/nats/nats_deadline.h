// How long one waits for a NATS server: until a moment, and no longer than somebody wants it.
//
// Units/frames: MonoTime of this process's clock.
// Ownership:    `ends` must outlive it.
// Threads:      any; `ends` may be set in another.
// Failure:      none.
#pragma once

#include <algorithm>
#include <atomic>

#include "core/net/mono_clock.h"

namespace dance {

class NatsDeadline {
 public:
  NatsDeadline(Duration longest, const std::atomic<bool>& ends)
      : end_(mono_now() + longest), ends_(ends) {}

  bool is_over() const { return ends_ || mono_now() >= end_; }
  // To wait for before is_over() is asked again.
  Duration slice() const {
    return std::clamp(end_ - mono_now(), Duration::ms(1), Duration::ms(100));
  }

 private:
  MonoTime end_;
  const std::atomic<bool>& ends_;
};

}  // namespace dance
