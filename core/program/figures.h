// Numbers for reports: rounding, and percentiles of stored samples. Histogram
// (core/base/histogram.h) is for samples too many to store.
//
// Units/frames: as given; fractions are 0 to 1.
// Ownership:    plain values.
// Threads:      none inside.
// Failure:      a percentile of no samples is 0.
#pragma once

#include <cmath>
#include <cstddef>
#include <span>

namespace dance {

// Rounded, to keep JSON short.
inline double rounded(double value, double per_unit) {
  return std::round(value * per_unit) / per_unit;
}

template <class T>
T percentile(std::span<const T> sorted, double fraction) {
  if (sorted.empty()) return T{};
  return sorted[static_cast<std::size_t>(fraction * static_cast<double>(sorted.size() - 1))];
}

}  // namespace dance
