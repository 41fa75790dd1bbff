// What `dance haptics --check` measures: orders at random moments, from the moment each was due to
// the moment its device had it; beside the same orders given out once a picture, as an engine
// would.
//
// Units/frames: milliseconds.
// Ownership:    plain values.
// Threads:      runs in the caller's poller for some seconds.
// Failure:      a device that takes nothing has no figures.
#pragma once

#include <string>
#include <vector>

#include "haptics/haptic_table.h"

namespace dance {

struct HapticCheck {
  std::string to, device;
  std::uint64_t played = 0, refused = 0;
  double p50_ms = 0.0, p99_ms = 0.0, most_ms = 0.0;
  double picture_p50_ms = 0.0, picture_p99_ms = 0.0;
};

Result<HapticCheck> check_haptics(const std::string& to, const HapticOptions& options,
                                  Poller& poller, Duration length);
std::string haptic_check_table(const std::vector<HapticCheck>& checks);

}  // namespace dance
