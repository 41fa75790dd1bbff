// A rotation in 47 bits: the three smaller components of the unit quaternion, 15 bits each, and
// which one is left out. q and −q are the same rotation, so the one left out is made positive.
//
// Units/frames: packed is  largest << 45 | a << 30 | b << 15 | c,  components in the order x y z w
//               without the largest; 16383 stands for 0 and 16383 steps for 1/√2.
// Ownership:    plain values.
// Threads:      none inside.
// Failure:      unpack gives nullopt for what pack never makes.
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>

namespace dance {

// Three components of half a step each, seen where they weigh most (all four components 0.5).
constexpr double kPackedRotationError_deg = 0.0087;

namespace detail {
constexpr int kRotationSteps = 16383;
constexpr double kLargestOfSmaller = 0.70710678118654752;  // bound of the second largest
}  // namespace detail

// q must be about unit; it is made exactly so first.
inline std::uint64_t pack_rotation(const Eigen::Quaternionf& q) {
  const Eigen::Vector4d v = q.coeffs().cast<double>().normalized();  // x y z w
  Eigen::Index largest = 3;
  v.cwiseAbs().maxCoeff(&largest);
  const double sign = v[largest] < 0.0 ? -1.0 : 1.0;
  std::uint64_t packed = static_cast<std::uint64_t>(largest);
  for (Eigen::Index i = 0; i < 4; ++i) {
    if (i == largest) continue;
    const auto steps = static_cast<int>(
        std::lround(sign * v[i] / detail::kLargestOfSmaller * detail::kRotationSteps));
    const int clipped = std::clamp(steps, -detail::kRotationSteps, detail::kRotationSteps);
    packed = packed << 15 | static_cast<std::uint64_t>(clipped + detail::kRotationSteps);
  }
  return packed;
}

inline std::optional<Eigen::Quaternionf> unpack_rotation(std::uint64_t packed) {
  if (packed >> 47 != 0) return std::nullopt;
  const auto largest = static_cast<Eigen::Index>(packed >> 45);
  Eigen::Vector4d v = Eigen::Vector4d::Zero();
  double rest = 1.0;
  int shift = 30;
  for (Eigen::Index i = 0; i < 4; ++i) {
    if (i == largest) continue;
    const int steps = static_cast<int>(packed >> shift & 0x7fff) - detail::kRotationSteps;
    if (steps > detail::kRotationSteps) return std::nullopt;
    v[i] = steps * (detail::kLargestOfSmaller / detail::kRotationSteps);
    rest -= v[i] * v[i];
    shift -= 15;
  }
  // The largest of four is at least a half; a little less is rounding.
  if (rest < 0.2499) return std::nullopt;
  v[largest] = std::sqrt(rest);
  Eigen::Quaternionf q;
  q.coeffs() = v.cast<float>();
  return q;
}

}  // namespace dance
