// smooth_step: from 0 at 0 to 1 at 1, with slope 0 at both ends, constant beyond them.
//
// Units/frames: none.
// Ownership:    plain values.
// Threads:      any.
// Failure:      none.
#pragma once

#include <algorithm>

namespace dance {

template <class Number>
Number smooth_step(Number x) {
  const Number c = std::clamp(x, Number(0), Number(1));
  return c * c * (Number(3) - Number(2) * c);
}

}  // namespace dance
