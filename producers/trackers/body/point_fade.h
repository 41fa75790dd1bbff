// PointFade: passes from where a point was measured to where it is guessed, and back, without a
// jump: at the change the difference stays, and decays.
//
// Units/frames: W, metres, rotation vectors in W.
// Ownership:    plain value; never allocates.
// Threads:      none inside; one owner.
// Failure:      none.
// Source:       inertialisation, as core/motion/inertializer.h.
#pragma once

#include <cmath>

#include "core/motion/rotation_vector.h"
#include "core/motion/spring.h"
#include "producers/trackers/tracker_mounts.h"

namespace dance {

class PointFade {
 public:
  static constexpr Duration kHalfLife = Duration::ms(110);

  void reset() { *this = PointFade(); }

  // `measured` is null where the point is not tracked; `jumps`: what is followed may be elsewhere
  // at once, as the guess where other points came or went. What it returns is the measured place
  // itself once nothing is left of an earlier guess.
  Place follow(const Place* measured, const Place& guessed, float seconds, bool jumps) {
    const bool is_measured = measured != nullptr;
    const Place& source = is_measured ? *measured : guessed;
    position_.advance(Spring::y_of_half_life(kHalfLife), seconds);
    rotation_.advance(Spring::y_of_half_life(kHalfLife), seconds);
    if (began_ && is_measured != was_measured_)
      cross(source, seconds);
    else if (began_ && jumps)
      bridge(source, seconds);
    was_measured_ = is_measured;
    began_ = true;
    if (position_.is_at_rest()) position_ = Spring();
    if (rotation_.is_at_rest()) rotation_ = Spring();
    Place shown = source;
    shown.p_W_m += position_.offset;
    if (!rotation_.is_at_rest())
      shown.R_W = (exp_rotation(rotation_.offset) * source.R_W).normalized();
    if (seconds > 0.0f) {
      velocity_m_s_ = (shown.p_W_m - shown_.p_W_m) / seconds;
      source_velocity_m_s_ = (source.p_W_m - source_.p_W_m) / seconds;
    }
    source_ = source;
    shown_ = shown;
    return shown;
  }

 private:
  static constexpr float kFastest_m_s = 6.0f;

  static Eigen::Vector3f way(const Eigen::Vector3f& velocity_m_s, float seconds) {
    const float speed = velocity_m_s.norm();
    return velocity_m_s * (speed > kFastest_m_s ? kFastest_m_s / speed : 1.0f) * seconds;
  }
  // From measured to guessed, or back: what was shown goes on as it went. Where a point comes and
  // goes in each frame the difference decays all the same.
  void cross(const Place& source, float seconds) {
    const float left = std::exp2(-seconds / static_cast<float>(kHalfLife.as_seconds()));
    position_ = Spring();
    rotation_ = Spring();
    position_.offset = left * (shown_.p_W_m + way(velocity_m_s_, seconds) - source.p_W_m);
    rotation_.offset = left * rotation_vector(shown_.R_W * source.R_W.conjugate());
  }
  // The same source went on elsewhere: its jump is added to what is left of earlier ones.
  void bridge(const Place& source, float seconds) {
    position_.offset += source_.p_W_m + way(source_velocity_m_s_, seconds) - source.p_W_m;
    rotation_.offset =
        rotation_vector(exp_rotation(rotation_.offset) * source_.R_W * source.R_W.conjugate());
  }

  Spring position_, rotation_;
  Place shown_, source_;
  Eigen::Vector3f velocity_m_s_ = Eigen::Vector3f::Zero();
  Eigen::Vector3f source_velocity_m_s_ = Eigen::Vector3f::Zero();
  bool was_measured_ = false, began_ = false;
};

}  // namespace dance
