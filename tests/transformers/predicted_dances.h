// Dances for the tests of prediction: the synthetic salsa dancer, one who stands, one who stops at
// once; still and seen by a sensor that trembles.
//
// Units/frames: 60 poses a second, from 1 s on, of clock 1.
// Ownership:    plain values.
// Threads:      none inside.
// Failure:      none.
#pragma once

#include <vector>

#include "core/base/random.h"
#include "core/motion/rotation_vector.h"
#include "producers/salsa/salsa_dancer.h"

namespace dance {

constexpr std::int64_t kDanceStep_ns = 16'666'667;

inline void stamp_dance(Pose& pose, std::size_t frame) {
  pose.sequence = static_cast<std::uint32_t>(frame);
  pose.clock_id = 1;
  pose.capture_time =
      MonoTime::from_us(1'000'000) + Duration::ns(kDanceStep_ns * static_cast<std::int64_t>(frame));
}

inline std::vector<Pose> salsa(std::size_t frames) {
  SalsaDancer dancer{SalsaStyle()};
  std::vector<Pose> poses(frames);
  for (std::size_t i = 0; i < frames; ++i) {
    dancer.dance_at(Duration::ns(kDanceStep_ns * static_cast<std::int64_t>(i)), poses[i]);
    stamp_dance(poses[i], i);
  }
  return poses;
}

inline std::vector<Pose> standing(std::size_t frames) {
  std::vector<Pose> poses(frames, salsa(30).back());
  for (std::size_t i = 0; i < frames; ++i) stamp_dance(poses[i], i);
  return poses;
}

// Dances for 2.5 s, stands still for 1.5 s, over and over; each time from one frame to the next.
inline std::vector<Pose> stopping(std::size_t frames) {
  const std::vector<Pose> whole = salsa(frames);
  std::vector<Pose> poses;
  std::size_t danced = 0;
  for (std::size_t i = 0; i < frames; ++i) {
    poses.push_back(whole[danced]);
    stamp_dance(poses.back(), i);
    if (i % 240 < 150) ++danced;
  }
  return poses;
}

inline std::vector<Pose> shaken(std::vector<Pose> poses, double sd_rad, std::uint64_t seed = 5) {
  Random random(seed);
  for (Pose& pose : poses)
    for (auto& q : pose.R_PB) {
      const double x = random.normal(), y = random.normal(), z = random.normal();
      q = q * exp_rotation(Eigen::Vector3d(x * sd_rad, y * sd_rad, z * sd_rad).cast<float>());
    }
  return poses;
}

// Mean angle between the bones of two poses but the hips, rad.
inline double mean_angle_rad(const Pose& a, const Pose& b) {
  double sum = 0.0;
  for (std::size_t i = 1; i < kBoneCount; ++i)
    sum += static_cast<double>(a.R_PB[i].angularDistance(b.R_PB[i]));
  return sum / (kBoneCount - 1);
}

}  // namespace dance
