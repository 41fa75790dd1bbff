// Poses as the memory of engines holds them, each of which tells its number in all of its values,
// so that one made of two is seen.
//
// Units/frames: as formats/engine/segment.h.
// Threads:      none inside.
// Failure:      none.
#pragma once

#include <algorithm>
#include <cmath>
#include <memory>

#include "core/pose/pose.h"
#include "formats/engine/segment.h"

namespace dance::engine {

constexpr std::int64_t kSomeTime_ns = 1'000'000'000'000;

inline StoredPose numbered(std::uint32_t number) {
  StoredPose pose{};
  const float angle = 0.001f * static_cast<float>(number % 1000);
  for (auto& q : pose.rotation_xyzw) {
    q[0] = std::sin(angle);
    q[3] = std::cos(angle);
  }
  for (float& x : pose.hips_m) x = static_cast<float>(number % 1000);
  pose.presence = kAllBones;
  pose.confidence = 1.0f;
  pose.sequence = number;
  pose.capture_ns = pose.staged_ns = kSomeTime_ns + number;
  pose.music_beats = number;
  return pose;
}

inline bool is_whole(const StoredPose& pose) {
  const StoredPose wanted = numbered(pose.sequence);
  return std::memcmp(&wanted, &pose, sizeof pose) == 0;
}

// Zeros, as fresh shared memory has them.
inline std::unique_ptr<Segment> fresh_segment() { return std::make_unique<Segment>(); }

}  // namespace dance::engine
