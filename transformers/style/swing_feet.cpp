#include "transformers/style/swing_feet.h"

#include <algorithm>
#include <cmath>

#include "core/base/smooth_step.h"

namespace dance {
namespace {

using Eigen::Vector3f;

// Slower than the one a foot stands, or is about to land; a step is faster than the other at its
// middle.
constexpr float kFootStands_m_s = 0.2f, kFootSwings_m_s = 1.0f;
// A sensor's noise is no step, and the delay is that of two poses.
constexpr float kFootSmooth_s = 0.025f;
constexpr float kFootFloorRises_m_s = 0.02f;

}  // namespace

void SwingFeet::Point::follow(const Vector3f& now_W_m, float dt_s, bool begins) {
  if (begins) *this = {now_W_m, Vector3f::Zero(), now_W_m.y()};
  v_W_m_s += ((now_W_m - p_W_m) / dt_s - v_W_m_s) * (dt_s / (dt_s + kFootSmooth_s));
  floor_m = std::min(now_W_m.y(), floor_m + kFootFloorRises_m_s * dt_s);
  p_W_m = now_W_m;
}

void SwingFeet::follow(const BodyFrames& frames, float dt_s, bool begins) {
  for (std::size_t side = 0; side < kSwingLegs.size(); ++side) {
    Foot& foot = feet_[side];
    foot.ankle.follow(frames.p_WB_m[ankle_of(side)], dt_s, begins);
    foot.ball.follow(frames.p_WB_m[ball_of(side)], dt_s, begins);
    const float speed = std::min(foot.ankle.v_W_m_s.norm(), foot.ball.v_W_m_s.norm());
    foot.swing = smooth_step((speed - kFootStands_m_s) / (kFootSwings_m_s - kFootStands_m_s));
  }
}

float SwingFeet::lowest_ankle_m(std::size_t side, const BodyFrames& danced) const {
  return std::min(feet_[side].ankle.floor_m, danced.p_WB_m[ankle_of(side)].y());
}

float SwingFeet::lowest_ball_m(std::size_t side, const BodyFrames& danced) const {
  return std::min(feet_[side].ball.floor_m, danced.p_WB_m[ball_of(side)].y());
}

}  // namespace dance
