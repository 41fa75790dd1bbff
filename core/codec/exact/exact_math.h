// Functions that give the same bits on every machine: made of + − × ÷ only, which IEEE 754 rounds
// exactly, while libm's may differ in the last bit. For codecs, whose two ends must agree.
// Everything that includes this is built with -ffp-contract=off.
//
// Units/frames: radians; errors are stated at each function, as seen by tests.
// Ownership:    none.
// Threads:      none inside.
// Failure:      arguments outside the stated range are our bug.
// Source:       Taylor's series after reduction of the argument.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

#include "core/base/assert.h"

namespace dance::exact {

constexpr double kPi = 3.141592653589793;
constexpr double kLargestAngle_rad = 1e6;

// Exact for |x| < 2^51; halves round away from 0.
inline double round_to_whole(double x) {
  const auto whole = static_cast<std::int64_t>(x);
  const double rest = x - static_cast<double>(whole);
  return static_cast<double>(whole + (rest >= 0.5 ? 1 : rest <= -0.5 ? -1 : 0));
}

namespace detail {

// Coefficients from the highest power down.
template <std::size_t kCount>
inline double polynomial(double x, const std::array<double, kCount>& coefficients) {
  double sum = coefficients[0];
  for (std::size_t i = 1; i < kCount; ++i) sum = sum * x + coefficients[i];
  return sum;
}

// |x| <= pi/4
inline double sin_near_zero(double x) {
  const double x2 = x * x;
  return x + x * x2 *
                 polynomial(x2, std::array{1.0 / 6227020800.0, -1.0 / 39916800.0, 1.0 / 362880.0,
                                           -1.0 / 5040.0, 1.0 / 120.0, -1.0 / 6.0});
}
inline double cos_near_zero(double x) {
  return polynomial(x * x, std::array{-1.0 / 87178291200.0, 1.0 / 479001600.0, -1.0 / 3628800.0,
                                      1.0 / 40320.0, -1.0 / 720.0, 1.0 / 24.0, -0.5, 1.0});
}

// sin(x + quarters · pi/2)
inline double sin_turned(double x, std::int64_t quarters) {
  DANCE_ASSERT(x >= -kLargestAngle_rad && x <= kLargestAngle_rad, x);
  // pi/2 in two parts, the first short enough for its product with a whole number to be exact.
  constexpr double kHigh = 1.5707963267341256;
  constexpr double kLow = 6.077100506506192e-11;
  const double n = round_to_whole(x * (2.0 / kPi));
  const double rest = (x - n * kHigh) - n * kLow;
  const std::int64_t quarter = (static_cast<std::int64_t>(n) + quarters) & 3;
  const double value = (quarter & 1) != 0 ? cos_near_zero(rest) : sin_near_zero(rest);
  return (quarter & 2) != 0 ? -value : value;
}

}  // namespace detail

// |x| <= kLargestAngle_rad. Error below 1e-13 for |x| < 100; beyond, |x| · 1e-15 more.
inline double sin(double x) { return detail::sin_turned(x, 0); }
inline double cos(double x) { return detail::sin_turned(x, 1); }

// The angle of (x, y) in [−pi, pi]; 0 for (0, 0). Finite arguments. Error below 1e-14.
inline double atan2(double y, double x) {
  constexpr std::array<double, 9> kAtanOfEighths{0.0,
                                                 0.12435499454676144,
                                                 0.24497866312686414,
                                                 0.35877067027057225,
                                                 0.4636476090008061,
                                                 0.5585993153435624,
                                                 0.6435011087932844,
                                                 0.7188299996216245,
                                                 0.7853981633974483};
  const double ax = x < 0.0 ? -x : x;
  const double ay = y < 0.0 ? -y : y;
  DANCE_ASSERT(ax <= 1.7976931348623157e308 && ay <= 1.7976931348623157e308, x, y);
  if (ax == 0.0 && ay == 0.0) return 0.0;
  const bool steep = ay > ax;
  const double slope = steep ? ax / ay : ay / ax;  // 0 to 1
  const auto eighth = static_cast<std::size_t>(slope * 8.0 + 0.5);
  const double centre = static_cast<double>(eighth) * 0.125;
  const double t = (slope - centre) / (1.0 + slope * centre);  // |t| <= 1/16
  const double t2 = t * t;
  double angle = kAtanOfEighths[eighth] + t +
                 t * t2 *
                     detail::polynomial(
                         t2, std::array{-1.0 / 11.0, 1.0 / 9.0, -1.0 / 7.0, 1.0 / 5.0, -1.0 / 3.0});
  if (steep) angle = kPi / 2.0 - angle;
  if (x < 0.0) angle = kPi - angle;
  return y < 0.0 ? -angle : angle;
}

// 2^x for −1022 <= x <= 1023: 0 below, infinity above. Relative error below 1e-13.
inline double exp2(double x) {
  DANCE_ASSERT(x == x, x);
  if (x < -1022.0) return 0.0;
  if (x >= 1023.5) return std::bit_cast<double>(std::uint64_t{0x7ff} << 52);
  const double whole = round_to_whole(x);
  const double y = (x - whole) * 0.6931471805599453;  // e^y, |y| < 0.35
  const double part = detail::polynomial(
      y, std::array{1.0 / 39916800.0, 1.0 / 3628800.0, 1.0 / 362880.0, 1.0 / 40320.0, 1.0 / 5040.0,
                    1.0 / 720.0, 1.0 / 120.0, 1.0 / 24.0, 1.0 / 6.0, 0.5, 1.0, 1.0});
  const auto exponent = static_cast<std::uint64_t>(static_cast<std::int64_t>(whole) + 1023);
  return part * std::bit_cast<double>(exponent << 52);
}

// 0 < x, finite. Error below 1e-14 near 1, of a few last bits elsewhere.
inline double log2(double x) {
  DANCE_ASSERT(x > 0.0 && x <= 1.7976931348623157e308, x);
  double exponent = 0.0;
  if (x < 2.2250738585072014e-308) {
    x *= 18014398509481984.0;  // 2^54
    exponent = -54.0;
  }
  const auto bits = std::bit_cast<std::uint64_t>(x);
  exponent += static_cast<double>(static_cast<std::int64_t>(bits >> 52) - 1023);
  double m = std::bit_cast<double>((bits & 0xfffffffffffffULL) | std::uint64_t{1023} << 52);
  if (m > 1.4142135623730951) {
    m *= 0.5;
    exponent += 1.0;
  }
  // ln m = 2 (s + s³/3 + s⁵/5 + …)
  const double s = (m - 1.0) / (m + 1.0);  // |s| < 0.172
  const double s2 = s * s;
  const double series =
      detail::polynomial(s2, std::array{1.0 / 17.0, 1.0 / 15.0, 1.0 / 13.0, 1.0 / 11.0, 1.0 / 9.0,
                                        1.0 / 7.0, 1.0 / 5.0, 1.0 / 3.0, 1.0});
  return exponent + s * series * 2.8853900817779268;
}

}  // namespace dance::exact
