// Poses to try the lattice codec with, of + − × ÷ and √ alone, so that they are the same on every
// machine: a dancer who sways, steps and spins, and poses that no body takes.
//
// Units/frames: as core/pose/pose.h.
// Ownership:    plain values.
// Threads:      none.
// Failure:      none.
#pragma once

#include "core/base/random.h"
#include "core/codec/exact/exact_math.h"
#include "core/pose/pose.h"
#include "tests/core/codec/rotations.h"

namespace dance {

inline Eigen::Quaternionf turned(double x, double y, double z) {
  const double n = std::sqrt(1.0 + x * x + y * y + z * z);
  return {static_cast<float>(1.0 / n), static_cast<float>(x / n), static_cast<float>(y / n),
          static_cast<float>(z / n)};
}

// Frame i of a dance at 60 frames a second, beat by beat, with some trembling.
inline Pose dance_frame(std::uint32_t i, Random& random, double tremble = 0.0005) {
  Pose pose;
  const double t = static_cast<double>(i) / 60.0;
  for (std::size_t b = 0; b < kBoneCount; ++b) {
    const double size = 0.05 + 0.03 * static_cast<double>(b % 7);
    const double pace = 2.0 + 0.7 * static_cast<double>(b % 5);
    pose.R_PB[b] = turned(size * exact::sin(pace * t) + tremble * random.normal(),
                          0.5 * size * exact::sin(pace * t + 1.0) + tremble * random.normal(),
                          size * exact::cos(0.5 * pace * t) + tremble * random.normal());
  }
  const double heading = 0.8 * t;
  pose.R_PB[0] = Eigen::Quaternionf(static_cast<float>(exact::cos(0.5 * heading)), 0.0f,
                                    static_cast<float>(exact::sin(0.5 * heading)), 0.0f) *
                 pose.R_PB[0];
  pose.p_WH_m = {static_cast<float>(0.4 * exact::sin(0.9 * t)),
                 static_cast<float>(0.92 + 0.02 * exact::sin(5.0 * t)),
                 static_cast<float>(0.3 * exact::cos(0.7 * t))};
  pose.sequence = i;
  pose.capture_time = MonoTime::from_us(1'000'000 + static_cast<std::int64_t>(i) * 16'667);
  return pose;
}

inline Pose any_pose(std::uint32_t sequence, Random& random) {
  Pose pose;
  for (auto& q : pose.R_PB) q = any_rotation(random);
  for (int axis = 0; axis < 3; ++axis)
    pose.p_WH_m[axis] = static_cast<float>(random.uniform(-900.0, 900.0));
  pose.sequence = sequence;
  return pose;
}

}  // namespace dance
