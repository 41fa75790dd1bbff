// A rotation as two angles of swing and one of twist about the z axis:
// Q = exp(u·x + v·y) · exp(w·z). Swing is where the bone points, twist how it is rolled about
// itself.
//
// Units/frames: radians; |(u, v)| ≤ π, w within ±π.
// Ownership:    plain values.
// Threads:      none inside.
// Failure:      a swing of exactly π has no direction of its own: one is chosen.
#pragma once

#include <array>

#include "core/codec/exact_geometry.h"
#include "core/codec/exact_math.h"
#include "core/codec/four_floats.h"

namespace dance::exact {

struct SwingTwist {
  double u = 0.0, v = 0.0, w = 0.0;
};

namespace detail {
// cos h and sin h / h, from h²: within 1e-7 for |h| ≤ 2.5, more than half a turn of the whole angle.
// Taylor's series, the two side by side.
struct CosSinc {
  double cos, sinc;
};
inline CosSinc cos_sinc_of_square(double h2) {
  constexpr double kFirst = -1.0 / 6402373705728000.0;
  static constexpr Two kTerms[] = {{1.0 / 20922789888000.0, 1.0 / 355687428096000.0},
                                   {-1.0 / 87178291200.0, -1.0 / 1307674368000.0},
                                   {1.0 / 479001600.0, 1.0 / 6227020800.0},
                                   {-1.0 / 3628800.0, -1.0 / 39916800.0},
                                   {1.0 / 40320.0, 1.0 / 362880.0},
                                   {-1.0 / 720.0, -1.0 / 5040.0},
                                   {1.0 / 24.0, 1.0 / 120.0},
                                   {-0.5, -1.0 / 6.0},
                                   {1.0, 1.0}};
  const Two x{h2, h2};
  Two sum{kFirst * h2 + kTerms[0][0], kTerms[0][1]};
  for (int i = 1; i < 9; ++i) sum = sum * x + kTerms[i];
  return {sum[0], sum[1]};
}
// atan t / t from t² ≤ 1, within 2e-8. Source: Abramowitz and Stegun 4.4.49.
inline double atan_of_square(double t2) {
  return polynomial(t2, std::array{0.0028662257, -0.0161657367, 0.0429096138, -0.0752896400,
                                   0.1065626393, -0.1420889944, 0.1999355085, -0.3333314528, 1.0});
}
}  // namespace detail

// |u|, |v|, |w| ≤ 3.5: all that a lattice has.
inline Quat to_quat(const SwingTwist& a) {
  const double h2 = 0.25 * (a.u * a.u + a.v * a.v);
  const auto [c, sinc] = detail::cos_sinc_of_square(h2);
  const double k = 0.5 * sinc;
  const double x = k * a.u, y = k * a.v;
  const double t2 = 0.25 * a.w * a.w;
  const auto [ct, sinc_t] = detail::cos_sinc_of_square(t2);
  const double st = 0.5 * a.w * sinc_t;
  return {c * ct, x * ct + y * st, y * ct - x * st, c * st};
}

// Of a unit quaternion; q and −q give the same.
inline SwingTwist to_swing_twist(const Quat& q) {
  const double c = std::sqrt(q.w * q.w + q.z * q.z);
  const double s = std::sqrt(q.x * q.x + q.y * q.y);
  SwingTwist a;
  double ct = 1.0, st = 0.0;
  if (c > 1e-12) {
    ct = q.w / c;
    st = q.z / c;
    a.w = 2.0 * atan2(st, ct);
    if (a.w > kPi) a.w -= 2.0 * kPi;
    if (a.w < -kPi) a.w += 2.0 * kPi;
  }
  if (s > 1e-12) {
    const double k = 2.0 * atan2(s, c) / s;
    a.u = k * (q.x * ct - q.y * st);
    a.v = k * (q.x * st + q.y * ct);
  }
  return a;
}

// The twist of a quaternion with these two components, within 1e-6: for predictions, which must be
// the same everywhere and need be no better.
inline double nearly_twist(double w, double z) {
  const double n = std::sqrt(w * w + z * z);
  if (n < 1e-12) return 0.0;
  const double t = (w < 0.0 ? -z : z) / (n + (w < 0.0 ? -w : w));
  return 4.0 * t * detail::atan_of_square(t * t);
}

// As to_swing_twist(), within 1e-6.
inline SwingTwist nearly_swing_twist(const Quat& q) {
  const double c = std::sqrt(q.w * q.w + q.z * q.z);
  const double s2 = q.x * q.x + q.y * q.y;
  const double inverse = 1.0 / (1.0 + c);
  const double k = 4.0 * inverse * detail::atan_of_square(s2 * inverse * inverse);
  if (c < 1e-9) return {k * q.x, k * q.y, 0.0};
  const double ct = q.w / c, st = q.z / c;
  return {k * (q.x * ct - q.y * st), k * (q.x * st + q.y * ct), nearly_twist(q.w, q.z)};
}

// What a little more of u, v or w turns the rotation about: axes in the frame that swing and twist
// begin in.
struct SwingTwistAxes {
  Vec u, v, w;
};
inline SwingTwistAxes axes_of(const SwingTwist& a) {
  const double h2 = 0.25 * (a.u * a.u + a.v * a.v);
  const auto [half_cos, half_sinc] = detail::cos_sinc_of_square(h2);
  const double s = half_sinc * half_cos;                             // sin θ / θ
  const double c = 0.5 * half_sinc * half_sinc;                      // (1 − cos θ) / θ²
  const double m = h2 > 1e-12 ? (1.0 - s) / (4.0 * h2) : 1.0 / 6.0;  // (1 − sin θ / θ) / θ²
  return {{s + m * a.u * a.u, m * a.u * a.v, -c * a.v},
          {m * a.u * a.v, s + m * a.v * a.v, c * a.u},
          {s * a.v, -s * a.u, 1.0 - 4.0 * c * h2}};
}

struct Swing {
  double u = 0.0, v = 0.0;
};
// The swing that turns the z axis to where d points, within 1e-6; d need not be of unit length.
inline Swing nearly_swing_to(const Vec& d) {
  const double rho2 = d.x * d.x + d.y * d.y;
  const double r = std::sqrt(rho2 + d.z * d.z);
  const double sum = r + (d.z < 0.0 ? -d.z : d.z);
  if (sum < 1e-12) return {};
  const double inverse = 1.0 / sum;
  double k = 2.0 * inverse * detail::atan_of_square(rho2 * inverse * inverse);
  if (d.z < 0.0) {
    if (rho2 < 1e-20) return {};
    k = kPi / std::sqrt(rho2) - k;
  }
  return {-k * d.y, k * d.x};
}

}  // namespace dance::exact
