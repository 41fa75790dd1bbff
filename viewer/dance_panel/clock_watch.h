// ClockWatch: tells when this machine's clock has jumped: it was set, or the machine slept.
//
// Units/frames: both clocks of this machine; the wall clock since its own zero.
// Ownership:    plain value.
// Threads:      none inside.
// Failure:      none.
#pragma once

#include <optional>

#include "core/base/time.h"

namespace dance {

class ClockWatch {
 public:
  // Slower than this it is a clock that is being corrected.
  static constexpr Duration kJump = Duration::ms(500);

  // By how much the wall clock has gone more than the other since the last look, if that is much.
  std::optional<Duration> look(MonoTime now, Duration wall) {
    const Duration before = apart_;
    const bool is_first = !looked_;
    apart_ = wall - (now - MonoTime());
    looked_ = true;
    const Duration jump = apart_ - before;
    if (is_first || (jump < kJump && jump > -kJump)) return std::nullopt;
    return jump;
  }

 private:
  Duration apart_;
  bool looked_ = false;
};

}  // namespace dance
