// A minute of the synthetic lead, or of the follow, at 60 Hz: what the benchmarks work on, the same
// every time.
//
// Units/frames: as core/pose/pose.h; capture times count from 1 s of clock 1.
// Ownership:    plain values.
// Threads:      none inside.
// Failure:      none.
#pragma once

#include <vector>

#include "producers/salsa/salsa_dancer.h"

namespace dance {

inline std::vector<Pose> salsa_poses(SalsaRole role = SalsaRole::kLead) {
  constexpr std::int64_t kFrames = 3600;
  SalsaStyle style;
  style.role = role;
  SalsaDancer dancer{style};
  std::vector<Pose> poses(kFrames);
  for (std::int64_t i = 0; i < kFrames; ++i) {
    Pose& pose = poses[static_cast<std::size_t>(i)];
    const Duration t = Duration::us(i * 1'000'000 / 60);
    dancer.dance_at(t, pose);
    pose.sequence = static_cast<std::uint32_t>(i);
    pose.clock_id = 1;
    pose.capture_time = MonoTime::from_us(1'000'000) + t;
  }
  return poses;
}

}  // namespace dance
