// Touch: two dancers touch on a stage, as one of them feels it.
//
// Units/frames: as lcmtypes/touch_t.lcm says; place in W, motion as the dancer sees it: to the
//               left, up, forward.
// Ownership:    plain value, no heap.
// Threads:      none inside.
// Failure:      is_valid() is false for an unknown phase or bone, and for what is out of range.
#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "core/base/guest_id.h"
#include "core/base/time.h"
#include "core/pose/bone.h"

namespace dance {

enum class TouchPhase : std::uint8_t { kBegins, kLasts, kEnded };

struct Touch {
  static constexpr float kMostDepth_m = 1.0f;
  static constexpr float kMostForce_n = 200.0f;
  static constexpr float kMostSpeed_m_s = 50.0f;

  MonoTime time;
  std::uint64_t clock_id = 0;
  std::uint32_t contact = 0;
  TouchPhase phase = TouchPhase::kBegins;
  bool is_hold = false;
  Bone bone = Bone::kHips;
  Bone other_bone = Bone::kHips;
  float depth_m = 0.0f;
  float force_n = 0.0f;
  float approach_m_s = 0.0f;
  Eigen::Vector3f motion_m_s = Eigen::Vector3f::Zero();
  Eigen::Vector3f place_m = Eigen::Vector3f::Zero();
  GuestId other;
};

inline bool is_valid(const Touch& touch) {
  const auto is_within = [](float value, float least, float most) {
    return value >= least && value <= most;
  };
  return touch.other.is_set() && touch.phase <= TouchPhase::kEnded &&
         index_of(touch.bone) < kBoneCount && index_of(touch.other_bone) < kBoneCount &&
         is_within(touch.depth_m, 0.0f, Touch::kMostDepth_m) &&
         is_within(touch.force_n, 0.0f, Touch::kMostForce_n) &&
         is_within(touch.approach_m_s, -Touch::kMostSpeed_m_s, Touch::kMostSpeed_m_s) &&
         touch.motion_m_s.allFinite() &&
         touch.motion_m_s.cwiseAbs().maxCoeff() <= Touch::kMostSpeed_m_s &&
         touch.place_m.allFinite() && touch.place_m.cwiseAbs().maxCoeff() <= 2000.0f;
}

}  // namespace dance
