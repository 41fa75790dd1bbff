// StallGuard: ends the program where it was asked to end and a call of the headset's runtime does
// not come back. A vendor's code may hang for good, and signals are only read between calls.
//
// Units/frames: none.
// Ownership:    owns its thread, which its destructor ends.
// Threads:      beat() on the guarded one. Made after signals are blocked, as it looks for pending
//               ones.
// Failure:      is what it is for: one line, and exit 1 without any cleaning up.
#pragma once

#include <atomic>
#include <functional>
#include <thread>

#include "core/base/time.h"

namespace dance {

class StallGuard {
 public:
  static constexpr Duration kPatience = Duration::s(4);

  // `is_asked` says, on any thread, whether the program was asked to end.
  explicit StallGuard(std::function<bool()> is_asked);
  ~StallGuard();
  StallGuard(const StallGuard&) = delete;
  StallGuard& operator=(const StallGuard&) = delete;

  // The guarded thread is between two calls.
  void beat();

 private:
  void watch();

  std::function<bool()> is_asked_;
  std::atomic<std::int64_t> beat_ns_{0};
  std::atomic<bool> ends_{false};
  std::thread thread_;
};

}  // namespace dance
