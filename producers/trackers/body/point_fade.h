// PointFade: passes from where a point was measured to where it is guessed, and back, without a
// jump: at the change the difference stays, and decays.
//
// Units/frames: W, metres, rotation vectors in W.
// Ownership:    plain value; never allocates.
// Threads:      none inside; one owner.
// Failure:      none.
// Source:       inertialisation, as core/motion/inertializer.h.
#pragma once

#include "core/motion/rotation_vector.h"
#include "core/motion/spring.h"
#include "producers/trackers/tracker_mounts.h"

namespace dance {

class PointFade {
 public:
  static constexpr Duration kHalfLife = Duration::ms(110);

  void reset() { *this = PointFade(); }

  // `measured` is null where the point is not tracked; `guess_changed`: points came or went, and
  // the guess may have jumped. What it returns is the measured place itself once nothing is left of
  // an earlier guess.
  Place follow(const Place* measured, const Place& guessed, float seconds, bool guess_changed) {
    const bool is_measured = measured != nullptr;
    const Place& source = is_measured ? *measured : guessed;
    position_.advance(Spring::y_of_half_life(kHalfLife), seconds);
    rotation_.advance(Spring::y_of_half_life(kHalfLife), seconds);
    if (began_ && (is_measured != was_measured_ || (guess_changed && !is_measured))) {
      position_ = Spring();
      rotation_ = Spring();
      position_.offset = shown_.p_W_m - source.p_W_m;
      rotation_.offset = rotation_vector(shown_.R_W * source.R_W.conjugate());
    }
    was_measured_ = is_measured;
    began_ = true;
    if (position_.is_at_rest()) position_ = Spring();
    if (rotation_.is_at_rest()) rotation_ = Spring();
    shown_ = source;
    shown_.p_W_m += position_.offset;
    if (!rotation_.is_at_rest())
      shown_.R_W = (exp_rotation(rotation_.offset) * source.R_W).normalized();
    return shown_;
  }

 private:
  Spring position_, rotation_;
  Place shown_;
  bool was_measured_ = false, began_ = false;
};

}  // namespace dance
