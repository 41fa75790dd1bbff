// Two dancers face to face, whose right and left hands are where a test wants them.
//
// Units/frames: metres in W.
// Ownership:    plain values.
// Threads:      none.
// Failure:      none.
#pragma once

#include "core/base/guest_id.h"
#include "core/motion/palm_pull.h"
#include "transformers/touch/hand_reach.h"

namespace dance {

inline GuestId guest_named(const char* name) { return *GuestId::parse(name); }
inline MonoTime touch_time(std::int64_t ms) { return MonoTime::from_us(1'000'000 + 1000 * ms); }

// Arms hang forward and down from the shoulders.
inline Pose standing(float z_m, float heading_rad) {
  Pose pose;
  pose.p_WH_m = {0.0f, average_skeleton().hips_height_m(), z_m};
  pose.R_PB[0] = Eigen::Quaternionf(Eigen::AngleAxisf(heading_rad, Eigen::Vector3f::UnitY()));
  const float turn = 1.2f;
  pose.R_PB[index_of(Bone::kLeftUpperArm)] =
      Eigen::Quaternionf(Eigen::AngleAxisf(-turn, Eigen::Vector3f::UnitZ()));
  pose.R_PB[index_of(Bone::kRightUpperArm)] =
      Eigen::Quaternionf(Eigen::AngleAxisf(turn, Eigen::Vector3f::UnitZ()));
  pose.R_PB[index_of(Bone::kLeftLowerArm)] =
      Eigen::Quaternionf(Eigen::AngleAxisf(-1.0f, Eigen::Vector3f::UnitY()));
  pose.R_PB[index_of(Bone::kRightLowerArm)] =
      Eigen::Quaternionf(Eigen::AngleAxisf(1.0f, Eigen::Vector3f::UnitY()));
  return pose;
}

inline Eigen::Vector3f palm_in(const Pose& pose, std::size_t side) {
  BodyFrames frames;
  forward_kinematics(average_skeleton(), pose, frames);
  return palm_of(average_skeleton(), frames, side);
}

// The pose with a palm at a place, as far as the arm reaches.
inline Pose with_palm_at(Pose pose, std::size_t side, const Eigen::Vector3f& place) {
  BodyFrames frames;
  forward_kinematics(average_skeleton(), pose, frames);
  move_hand(side, place - palm_of(average_skeleton(), frames, side), pose, frames);
  return pose;
}

// Half a metre before each other; +Z and -Z.
inline Pose lead_pose() { return standing(-0.35f, 0.0f); }
inline Pose follow_pose() { return standing(0.35f, 3.14159265f); }
// Between the two, where a left and a right hand meet.
inline Eigen::Vector3f meeting_place() { return {0.25f, 1.1f, 0.0f}; }

}  // namespace dance
