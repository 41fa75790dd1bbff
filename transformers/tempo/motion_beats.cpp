#include "transformers/tempo/motion_beats.h"

#include <algorithm>
#include <cmath>

namespace dance {
namespace {

// A swing is at least so fast; a foot that slides in balance is not stepping.
constexpr float kSwing_m_s = 0.4f;
// It stands when it has come down to this part of its swing's peak.
constexpr float kStood = 0.3f;
// A turn of the hips is believed when they have come back so far.
constexpr float kTurn_m = 0.012f;

}  // namespace

void MotionBeats::forget() { *this = MotionBeats(); }

void MotionBeats::put(MonoTime time, MotionBeat::Kind kind, float strength) {
  beats_[count_ % kKept] = {time, kind, strength};
  ++count_;
}

std::size_t MotionBeats::add(const MotionFrame& frame) {
  const std::uint64_t before = count_;
  const auto dt_s = static_cast<float>((frame.time - last_).as_seconds());
  if (has_last_ && dt_s > 0.0f) {
    for (std::size_t side = 0; side < 2; ++side) step(side, frame, dt_s);
  } else {
    for (std::size_t side = 0; side < 2; ++side) feet_[side].p_W_m = frame.p_WFoot_m[side];
  }
  sway(frame);
  last_ = frame.time;
  has_last_ = true;
  return static_cast<std::size_t>(count_ - before);
}

void MotionBeats::step(std::size_t side, const MotionFrame& frame, float dt_s) {
  Foot& foot = feet_[side];
  const float before = foot.speed;
  foot.speed = (frame.p_WFoot_m[side] - foot.p_W_m).norm() / dt_s;
  foot.p_W_m = frame.p_WFoot_m[side];
  if (foot.speed > kSwing_m_s) foot.is_swinging = true;
  if (!foot.is_swinging) return;
  foot.peak = std::max(foot.peak, foot.speed);
  const float stood = kStood * foot.peak;
  if (foot.speed > stood || before <= stood) return;
  // Speeds belong to the middle between two frames.
  const float part = (before - stood) / (before - foot.speed);
  const double back_s = static_cast<double>(dt_s) * (1.5 - static_cast<double>(part));
  put(frame.time - Duration::seconds(back_s),
      side == 0 ? MotionBeat::Kind::kLeftFootFall : MotionBeat::Kind::kRightFootFall, foot.peak);
  foot.is_swinging = false;
  foot.peak = 0.0f;
}

void MotionBeats::sway(const MotionFrame& frame) {
  sway_m_ = {frame.sway_m, sway_m_[0], sway_m_[1]};
  if (++sway_count_ < 3) {
    extreme_m_ = turned_m_ = frame.sway_m;
    extreme_time_ = frame.time;
    return;
  }
  const float side = is_to_left_ ? 1.0f : -1.0f;
  const float middle = sway_m_[1];
  if (side * (middle - extreme_m_) >= 0.0f) {
    extreme_m_ = middle;
    extreme_time_ = last_;
    const float bend = sway_m_[0] - 2.0f * middle + sway_m_[2];
    if (side * bend < 0.0f) {
      const float top = std::clamp(0.5f * (sway_m_[2] - sway_m_[0]) / bend, -0.5f, 0.5f);
      extreme_time_ +=
          Duration::seconds(static_cast<double>(top) * (frame.time - last_).as_seconds());
    }
  }
  if (side * (extreme_m_ - sway_m_[0]) < kTurn_m) return;
  put(extreme_time_, is_to_left_ ? MotionBeat::Kind::kSwayToLeft : MotionBeat::Kind::kSwayToRight,
      std::abs(extreme_m_ - turned_m_));
  turned_m_ = extreme_m_;
  extreme_m_ = sway_m_[0];
  extreme_time_ = frame.time;
  is_to_left_ = !is_to_left_;
}

}  // namespace dance
