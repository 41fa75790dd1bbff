// Vectors and quaternions in doubles with + − × ÷ and √ alone, each operation in the order written:
// both ends of the codec must compute the same to the last bit, whatever the compiler, processor
// and flags. Eigen may reorder sums, so it is not used here.
//
// Units/frames: quaternions are Hamilton's; rotate(q, v) turns v by q.
// Ownership:    plain values.
// Threads:      none inside.
// Failure:      none; NaN in, NaN out.
#pragma once

#include <cmath>

namespace dance::exact {

struct Vec {
  double x = 0.0, y = 0.0, z = 0.0;
};

[[gnu::always_inline]] inline Vec operator+(const Vec& a, const Vec& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
[[gnu::always_inline]] inline Vec operator-(const Vec& a, const Vec& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
[[gnu::always_inline]] inline Vec operator*(double k, const Vec& a) {
  return {k * a.x, k * a.y, k * a.z};
}
[[gnu::always_inline]] inline double dot(const Vec& a, const Vec& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
[[gnu::always_inline]] inline Vec cross(const Vec& a, const Vec& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
[[gnu::always_inline]] inline double length(const Vec& a) { return std::sqrt(dot(a, a)); }

struct Quat {
  double w = 1.0, x = 0.0, y = 0.0, z = 0.0;
};

[[gnu::always_inline]] inline Quat operator*(const Quat& a, const Quat& b) {
  return {
      a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z, a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y,
      a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x, a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w};
}
[[gnu::always_inline]] inline Quat conj(const Quat& q) { return {q.w, -q.x, -q.y, -q.z}; }
[[gnu::always_inline]] inline double dot(const Quat& a, const Quat& b) {
  return a.w * b.w + a.x * b.x + a.y * b.y + a.z * b.z;
}
[[gnu::always_inline]] inline Quat normalized(const Quat& q) {
  const double k = 1.0 / std::sqrt(dot(q, q));
  return {k * q.w, k * q.x, k * q.y, k * q.z};
}
// v + 2 w (u × v) + 2 u × (u × v)
[[gnu::always_inline]] inline Vec rotate(const Quat& q, const Vec& v) {
  const Vec u{q.x, q.y, q.z};
  const Vec t = 2.0 * cross(u, v);
  return v + q.w * t + cross(u, t);
}

}  // namespace dance::exact
