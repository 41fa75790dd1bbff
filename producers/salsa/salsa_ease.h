// The curves that salsa motion is made of: an S-curve with soft ends, and sums of S-curves that
// turn a value per beat into a flow.
//
// Units/frames: beats along the curve; the value's own unit across it.
// Threads:      none inside; pure functions.
// Failure:      none.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace dance::salsa {

constexpr double kPi = 3.14159265358979323846;
constexpr double radians(double degrees) { return degrees * (kPi / 180.0); }

// 10u³ − 15u⁴ + 6u⁵ within 0..1: speed and acceleration are zero at both ends.
constexpr double ease(double u) {
  if (u <= 0.0) return 0.0;
  if (u >= 1.0) return 1.0;
  return u * u * u * (10.0 + u * (6.0 * u - 15.0));
}

// 16u²(1−u)² within 0..1: a bump of height 1 that rises before ease() starts to move and ends after
// it, so that a foot does not scrape the floor.
constexpr double hill(double u) {
  if (u <= 0.0 || u >= 1.0) return 0.0;
  const double v = 4.0 * u * (1.0 - u);
  return v * v;
}

// The angle in (−π, π] that is the same direction.
inline double wrapped_angle(double angle_rad) { return std::remainder(angle_rad, 2.0 * kPi); }

// v(b) = v₀ + Σ (vₙ − vₙ₋₁) · ease((b − n − delay)/width + ½): each beat's value is taken up over
// `width` beats around n + delay. value_at(n) is asked for whole beats only.
template <class ValueAt>
auto flow(double beats, double width_beats, double delay_beats, const ValueAt& value_at) {
  const double last_settled = std::floor(beats - delay_beats - 0.5 * width_beats);
  const double last_begun = std::floor(beats - delay_beats + 0.5 * width_beats);
  auto n = static_cast<std::int64_t>(last_settled);
  auto previous = value_at(n);
  auto value = previous;
  while (n < static_cast<std::int64_t>(last_begun)) {
    ++n;
    const auto next = value_at(n);
    const double u = (beats - static_cast<double>(n) - delay_beats) / width_beats + 0.5;
    value = value + (next - previous) * ease(u);
    previous = next;
  }
  return value;
}

}  // namespace dance::salsa
