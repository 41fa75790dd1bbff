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

  // `measured` is null where the point is not tracked. What it returns is the measured place itself
  // once nothing is left of an earlier guess.
  Place follow(const Place* measured, const Place& guessed, float seconds) {
    const bool is_measured = measured != nullptr;
    const Place& source = is_measured ? *measured : guessed;
    position_.advance(Spring::y_of_half_life(kHalfLife), seconds);
    rotation_.advance(Spring::y_of_half_life(kHalfLife), seconds);
    if (began_ && is_measured != was_measured_) {
      // The guess of the frame before tells how far the body went since; the measured place of
      // then is the shown one.
      const Place& before = is_measured ? guessed : guessed_before_;
      const Place& from = is_measured ? source : before;
      Eigen::Vector3f moved = is_measured ? Eigen::Vector3f(guessed.p_W_m - guessed_before_.p_W_m)
                                          : Eigen::Vector3f(Eigen::Vector3f::Zero());
      position_.offset = shown_.p_W_m + moved - from.p_W_m;
      position_.velocity.setZero();
      const Eigen::Quaternionf turned =
          is_measured ? Eigen::Quaternionf(guessed.R_W * guessed_before_.R_W.conjugate())
                      : Eigen::Quaternionf::Identity();
      rotation_.offset = rotation_vector(turned * shown_.R_W * from.R_W.conjugate());
      rotation_.velocity.setZero();
    }
    was_measured_ = is_measured;
    guessed_before_ = guessed;
    began_ = true;
    shown_ = source;
    if (position_.is_at_rest()) position_ = Spring();
    if (rotation_.is_at_rest()) rotation_ = Spring();
    shown_.p_W_m += position_.offset;
    shown_.R_W = (exp_rotation(rotation_.offset) * source.R_W).normalized();
    return shown_;
  }

  // Whether anything but the guess is shown.
  bool is_held() const {
    return was_measured_ || !position_.is_at_rest() || !rotation_.is_at_rest();
  }

 private:
  Spring position_, rotation_;
  Place shown_, guessed_before_;
  bool was_measured_ = false, began_ = false;
};

}  // namespace dance
