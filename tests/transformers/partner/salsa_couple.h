// A synthetic couple that dances salsa in hold, and what one of them looks like beside the other.
//
// Units/frames: 60 poses a second, from 1 s on, of clock 1.
// Ownership:    plain values.
// Threads:      none inside.
// Failure:      none.
#pragma once

#include <vector>

#include "core/base/guest_id.h"
#include "core/motion/palm_pull.h"
#include "producers/salsa/salsa_dancer.h"
#include "transformers/partner/hand_holds.h"

namespace dance {

inline const GuestId kHere = *GuestId::parse("here");
constexpr double kCoupleHz = 60.0;

inline MonoTime couple_time(std::size_t frame) {
  return MonoTime::from_us(1'000'000) + Duration::seconds(static_cast<double>(frame) / kCoupleHz);
}

inline std::vector<Pose> salsa_of(SalsaRole role, std::size_t frames, std::uint64_t seed = 1) {
  SalsaStyle style;
  style.role = role;
  style.seed = seed;
  SalsaDancer dancer{style};
  std::vector<Pose> poses(frames);
  for (std::size_t i = 0; i < frames; ++i) {
    dancer.dance_at(couple_time(i) - couple_time(0), poses[i]);
    poses[i].sequence = static_cast<std::uint32_t>(i);
    poses[i].clock_id = 1;
    poses[i].capture_time = couple_time(i);
  }
  return poses;
}

inline Palms palms_of(const Skeleton& skeleton, const Pose& pose) {
  BodyFrames frames;
  forward_kinematics(skeleton, pose, frames);
  return {palm_of(skeleton, frames, 0), palm_of(skeleton, frames, 1)};
}

}  // namespace dance
