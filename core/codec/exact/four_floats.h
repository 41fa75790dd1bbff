// Portable SIMD: four floats or two doubles, each operation rounded as for one, so the same bits on
// every machine.
//
// Units/frames: none.
// Ownership:    plain values.
// Threads:      none inside.
// Failure:      none.
#pragma once

#include <cmath>
#include <cstdint>
#ifdef __SSE__
#include <xmmintrin.h>
#endif

namespace dance::exact {

using Four = float __attribute__((vector_size(16)));
using FourInts = std::int32_t __attribute__((vector_size(16)));
using Two = double __attribute__((vector_size(16)));

inline Two load_two(const double* aligned) { return *reinterpret_cast<const Two*>(aligned); }
inline Four all(float x) { return Four{x, x, x, x}; }
inline Four load_four(const float* aligned) { return *reinterpret_cast<const Four*>(aligned); }
inline void store_four(float* aligned, Four x) { *reinterpret_cast<Four*>(aligned) = x; }
inline Four abs(Four x) {
  return reinterpret_cast<Four>(reinterpret_cast<FourInts>(x) & 0x7fff'ffff);
}
inline Four max(Four a, Four b) {
#ifdef __SSE__
  return _mm_max_ps(a, b);
#else
  return a > b ? a : b;
#endif
}
template <typename T>
T at_least(T x, T least) {
  return x > least ? x : least;
}
template <typename T>
T at_most(T x, T most) {
  return x < most ? x : most;
}
inline Four sqrt(Four x) {
#ifdef __SSE__
  return _mm_sqrt_ps(x);
#else
  return Four{std::sqrt(x[0]), std::sqrt(x[1]), std::sqrt(x[2]), std::sqrt(x[3])};
#endif
}
// x where the mask is set, 0 elsewhere.
inline Four only(FourInts mask, Four x) {
  return reinterpret_cast<Four>(mask & reinterpret_cast<FourInts>(x));
}
inline Four choose(FourInts mask, Four x, Four otherwise) {
  return reinterpret_cast<Four>((mask & reinterpret_cast<FourInts>(x)) |
                                (~mask & reinterpret_cast<FourInts>(otherwise)));
}
inline Four to_floats(Two a, Two b) {
  using TwoFloats = float __attribute__((vector_size(8)));
  return __builtin_shufflevector(__builtin_convertvector(a, TwoFloats),
                                 __builtin_convertvector(b, TwoFloats), 0, 1, 2, 3);
}
inline Four to_floats(double a, double b, double c, double d) {
  return to_floats(Two{a, b}, Two{c, d});
}
// Transpose.
inline void transpose(Four& a, Four& b, Four& c, Four& d) {
  const Four ab = __builtin_shufflevector(a, b, 0, 4, 1, 5);
  const Four cd = __builtin_shufflevector(c, d, 0, 4, 1, 5);
  const Four ab_high = __builtin_shufflevector(a, b, 2, 6, 3, 7);
  const Four cd_high = __builtin_shufflevector(c, d, 2, 6, 3, 7);
  a = __builtin_shufflevector(ab, cd, 0, 1, 4, 5);
  b = __builtin_shufflevector(ab, cd, 2, 3, 6, 7);
  c = __builtin_shufflevector(ab_high, cd_high, 0, 1, 4, 5);
  d = __builtin_shufflevector(ab_high, cd_high, 2, 3, 6, 7);
}
inline float sum(Four x) { return (x[0] + x[1]) + (x[2] + x[3]); }

// log2 of positive numbers, linear between powers of two: exponent and mantissa read as one number.
inline Four rough_log2(Four x) {
  return __builtin_convertvector(reinterpret_cast<FourInts>(x), Four) * 0x1p-23f - 127.0f;
}
inline float rough_log2(float x) { return rough_log2(all(x))[0]; }

// atan t / t from t² ≤ 1, within 2e-5. Source: Abramowitz and Stegun 4.4.47.
inline Four atan_of_square(Four t2) {
  Four p = all(0.0208351f);
  p = p * t2 - 0.0851330f;
  p = p * t2 + 0.1801410f;
  p = p * t2 - 0.3302995f;
  return p * t2 + 0.9998660f;
}

}  // namespace dance::exact
