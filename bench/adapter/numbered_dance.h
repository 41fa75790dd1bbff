// A dance whose every pose tells its number in each of its values, so that a pose that is made of
// two is seen.
//
// Units/frames: poses as in core/pose.
// Ownership:    plain values.
// Threads:      none inside.
// Failure:      is_torn() of a pose that is not of this dance is true.
#pragma once

#include <cmath>

#include "consumers/engine/dance_adapter.h"
#include "core/pose/pose.h"

namespace dance {

inline float numbered_angle_rad(std::uint32_t sequence) {
  return 0.4f * std::sin(0.11f * static_cast<float>(sequence % 65536));
}
inline float numbered_place_m(std::uint32_t sequence) {
  return 0.3f * std::sin(0.07f * static_cast<float>(sequence % 65536));
}

inline Pose numbered_pose(std::uint32_t sequence) {
  Pose pose;
  pose.R_PB.fill(Eigen::Quaternionf(
      Eigen::AngleAxisf(numbered_angle_rad(sequence), Eigen::Vector3f::UnitX())));
  pose.p_WH_m = Eigen::Vector3f(numbered_place_m(sequence), 0.9f, numbered_place_m(sequence));
  pose.sequence = sequence;
  return pose;
}

inline bool is_torn(const dance_pose& pose) {
  constexpr float kRounding = 1e-5f;
  const float sine = std::sin(0.5f * numbered_angle_rad(pose.sequence));
  const float place = numbered_place_m(pose.sequence);
  bool torn = std::abs(pose.hips_position[0] - place) > kRounding ||
              std::abs(pose.hips_position[2] - place) > kRounding;
  for (const auto& q : pose.rotation) torn |= std::abs(q[0] - sine) > kRounding;
  return torn;
}

}  // namespace dance
