// The median of values that are at hand.
//
// Units/frames: as given.
// Ownership:    reorders the caller's values; allocates nothing.
// Threads:      none inside.
// Failure:      0 of none. Of an even number it is the upper of the two in the middle.
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>

namespace dance {

template <class T>
T median_of(std::span<T> values) {
  if (values.empty()) return T{};
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace dance
