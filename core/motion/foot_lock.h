// FootLock: feet that stand stay where they stand. What is predicted or corrected moves the whole
// body, and feet that should carry it skate; here the ball of a standing foot is held in its place
// and the leg is solved anew up to the hip. When the foot lifts, what was held dies away as a
// spring does.
//
// Units/frames: metres in W, +Y up; times of the stage's clock. Which height the floor has is
//               learned from the lowest places of the feet.
// Ownership:    plain value; never allocates.
// Threads:      none inside; one owner.
// Failure:      none. A leg is not stretched beyond its reach: the foot gives way. After a gap in
//               time, or where the dancer is suddenly elsewhere, nothing is held.
// Source:       foot skate clean-up as in Kovar, Schreiner, Gleicher, SCA 2002, made causal:
//               thresholds with hysteresis, and an inertialised release.
#pragma once

#include <Eigen/Core>
#include <array>

#include "core/base/time.h"
#include "core/motion/spring.h"
#include "core/pose/kinematics.h"
#include "core/pose/pose.h"
#include "core/pose/skeleton.h"

namespace dance {

class FootLock {
 public:
  struct Settings {
    float lock_below_m_s = 0.15f;
    float release_above_m_s = 0.35f;
    // The same while it is known how the feet moved a moment ago: a prediction lets them land late
    // and slide to their place, so that most of what seems to move stands.
    float seen_lock_below_m_s = 0.7f;
    float seen_release_above_m_s = 1.2f;
    float lock_below_m = 0.05f;  // of the ball over the floor
    float release_above_m = 0.08f;
    float furthest_m = 0.12f;  // a foot that ought to be so far away is let go
    // A foot that was seen to stand a moment ago does so until it is predicted to be so far away.
    float lifts_beyond_m = 0.07f;
    Duration release_half_life = Duration::ms(60);
  };

  FootLock();
  explicit FootLock(const Settings& settings);
  void set_body(const Skeleton& skeleton);
  void set_settings(const Settings& settings) { settings_ = settings; }

  // What was really danced, as it becomes known: which feet stand, and where. Predictions alone are
  // told less well.
  void observe(const Pose& real, MonoTime now);

  // Moves the legs of `pose`, which is to be shown at `now`. With `may_lock` false nothing new is
  // held and what is held is let go; once that has died away the pose is not touched. Returns
  // whether it was.
  bool apply(MonoTime now, Pose& pose, bool may_lock = true);

  void clear();
  bool is_locked(std::size_t side) const { return feet_[side].locked; }

 private:
  // What was seen before tells nothing of now.
  static constexpr Duration kFresh = Duration::ms(250);
  struct Foot {
    Eigen::Vector3f raw = Eigen::Vector3f::Zero();    // the ball, as it came in the last frame
    Eigen::Vector3f held = Eigen::Vector3f::Zero();   // where it is held
    Eigen::Vector3f glide = Eigen::Vector3f::Zero();  // m/s: comes to rest instead of stopping dead
    Spring shift;                                     // what is added to the ball
    float speed_m_s = 0.0f;
    bool locked = false;
    // Of what was really danced.
    Eigen::Vector3f seen = Eigen::Vector3f::Zero();
    float seen_speed_m_s = 0.0f;
    bool seen_standing = false;
  };

  void follow_floor(float low_m, float seconds);
  void follow(Foot& foot, const Eigen::Vector3f& raw, float seconds, bool may_lock);
  bool should_hold(const Foot& foot) const;
  bool is_fresh() const { return seen_at_.is_set() && time_ - seen_at_ < kFresh; }
  void move_leg(const Limb& leg, const Eigen::Vector3f& offset, Pose& pose, BodyFrames& frames);

  Settings settings_;
  Skeleton skeleton_;
  std::array<Foot, 2> feet_;
  float floor_m_ = 0.0f;  // of the balls
  MonoTime time_, seen_at_, seen_capture_;
  bool began_ = false;
};

}  // namespace dance
