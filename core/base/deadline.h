// Deadlines: a moment at which something is to be done, or not set where nothing is.
//
// Units/frames: MonoTime, both of the same clock.
// Ownership:    plain values.
// Threads:      any.
// Failure:      none.
#pragma once

#include <algorithm>

#include "core/base/time.h"

namespace dance {

// Of two deadlines, of which either may not be set.
constexpr MonoTime earlier(MonoTime a, MonoTime b) {
  if (!a.is_set()) return b;
  return b.is_set() ? std::min(a, b) : a;
}

}  // namespace dance
