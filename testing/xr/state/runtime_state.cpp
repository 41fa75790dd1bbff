#include "testing/xr/state/runtime_state.h"

#include <ctime>

namespace dance::test_xr {

Runtime& runtime() {
  static Runtime state;
  return state;
}

XrTime now_ns() {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return static_cast<XrTime>(now.tv_sec) * 1'000'000'000 + now.tv_nsec + kTimeOffset_ns;
}

double script_time_s(XrTime time_ns) {
  const auto& start_ns = runtime().clock_start_ns;
  return start_ns ? static_cast<double>(time_ns - *start_ns) * 1e-9 : 0.0;
}

double script_now_s() { return script_time_s(now_ns()); }

}  // namespace dance::test_xr
