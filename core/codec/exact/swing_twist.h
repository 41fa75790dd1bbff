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

#include "core/codec/exact/exact_geometry.h"
#include "core/codec/exact/exact_math.h"
#include "core/codec/exact/four_floats.h"

namespace dance::exact {

struct SwingTwist {
  double u = 0.0, v = 0.0, w = 0.0;
};

namespace detail {
// cos h and sin h / h, from h²: within 1e-7 for |h| ≤ 2.5, more than half a turn of the whole
// angle. Taylor's series, the two side by side.
struct CosSinc {
  double cos, sinc;
};
[[gnu::always_inline]] inline CosSinc cos_sinc_of_square(double h2) {
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
// atan t / t from t² ≤ 1, within 2e-8, of two; the terms in pairs, for speed. Source: Abramowitz
// and Stegun 4.4.49.
inline Two atan_of_square(Two t2) {
  const Two t4 = t2 * t2, t8 = t4 * t4;
  const Two a = 1.0 - 0.3333314528 * t2, b = 0.1999355085 - 0.1420889944 * t2;
  const Two c = 0.1065626393 - 0.0752896400 * t2, d = 0.0429096138 - 0.0161657367 * t2;
  return (a + b * t4) + t8 * ((c + d * t4) + 0.0028662257 * t8);
}
}  // namespace detail

// |u|, |v|, |w| ≤ 3.5: all that a lattice has.
[[gnu::always_inline]] inline Quat to_quat(const SwingTwist& a) {
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

// Axes about which small changes of u, v and w turn the rotation, in the frame of swing and twist.
struct SwingTwistAxes {
  Vec u, v, w;
};
// As to_swing_twist(), within 1e-6, and the axes there; for results that need not be bit-exact.
struct NearSwingTwist {
  SwingTwist angles;
  SwingTwistAxes axes;
};
[[gnu::always_inline]] inline NearSwingTwist nearly_swing_twist(const Quat& q) {
  const double c = std::sqrt(q.w * q.w + q.z * q.z);  // cos h, h half the swing θ
  const double s2 = q.x * q.x + q.y * q.y;
  const double inverse = 1.0 / (1.0 + c);
  const double swing_t2 = s2 * inverse * inverse;
  const double twist_t = c < 1e-9 ? 0.0 : (q.w < 0.0 ? -q.z : q.z) / (c + std::abs(q.w));
  const Two atans = detail::atan_of_square(Two{swing_t2, twist_t * twist_t});
  double u = q.x, v = q.y, scale = 4.0 * inverse;
  if (c >= 1e-9) {
    u = q.x * q.w - q.y * q.z;
    v = q.x * q.z + q.y * q.w;
    scale /= c;
  }
  u *= scale * atans[0];
  v *= scale * atans[0];
  // Of the swing θ: (1 − sin θ / θ) / θ², sin θ / θ and (1 − cos θ) / θ², within 1e-3.
  const double t2 = u * u + v * v, t4 = t2 * t2;
  const double m = (1.0 / 6.0 - t2 * (1.0 / 120.0)) +
                   t4 * ((1.0 / 5040.0 - t2 * (1.0 / 362880.0)) + t4 * (1.0 / 39916800.0));
  const double s = 1.0 - m * t2;
  const double d = (0.5 - t2 * (1.0 / 24.0)) +
                   t4 * ((1.0 / 720.0 - t2 * (1.0 / 40320.0)) + t4 * (1.0 / 3628800.0));
  return {{u, v, 4.0 * twist_t * atans[1]},
          {{s + m * u * u, m * u * v, -d * v},
           {m * u * v, s + m * v * v, d * u},
           {s * v, -s * u, 1.0 - d * t2}}};
}

}  // namespace dance::exact
