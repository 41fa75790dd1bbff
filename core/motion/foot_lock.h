// FootLock: removes foot skate. Predictions and corrections move the whole body, so standing feet
// would slide; the ball of a standing foot is held in place and the leg solved by two-bone IK. When
// the foot lifts, the offset decays as a spring.
//
// Units/frames: metres in W, +Y up; times of the stage's clock. The floor's height is estimated
//               from the lowest places of the feet.
// Ownership:    plain value; never allocates.
// Threads:      none inside; one owner.
// Failure:      none. A leg is not stretched beyond its reach: the foot moves instead. After a gap
//               in time, or a jump of the dancer, nothing is held.
// Source:       foot skate clean-up as in Kovar, Schreiner, Gleicher, SCA 2002, made causal:
//               thresholds with hysteresis, and an inertialised release.
#pragma once

#include <Eigen/Core>
#include <array>

#include "core/base/time.h"
#include "core/motion/hold_odds.h"
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
    // Thresholds while recent foot motion is known: predicted feet land late and slide into place,
    // so most that seem to move stand.
    float seen_lock_below_m_s = 0.7f;
    float seen_release_above_m_s = 1.2f;
    float lock_below_m = 0.05f;  // of the ball over the floor
    float release_above_m = 0.08f;
    float furthest_m = 0.12f;  // a foot that should be so far away is released
    // A foot that stood a moment ago is held until its predicted place is this far away.
    float lifts_beyond_m = 0.07f;
    // Where it is foreseen which feet stand: a foot that stands more often than it slides is worth
    // one that steps late, so that low odds do (HoldOdds); and it may be further off what is
    // predicted, the less sure that is.
    float release_odds_below = 0.1f;
    float sure_furthest_m = 0.2f;
    float unsure_furthest_m = 0.35f;
    Duration unsure_from = Duration::ms(200);
    Duration release_half_life = Duration::ms(50);
  };

  FootLock();
  explicit FootLock(const Settings& settings);
  void set_body(const Skeleton& skeleton);

  // The poses that arrived: which feet stand, and where. Detection from predictions alone is less
  // reliable.
  void observe(const Pose& real, MonoTime now);

  // Of the pose that is next to be shown, so far ahead of the newest that came: what is predicted
  // kStandingOddsStep before it, then, and after. With it feet are held as long as it is likely
  // enough that they stand, and take their step where it is not.
  void foresee(const Pose& before, const Pose& there, const Pose& after, Duration ahead);

  // Moves the legs of `pose`, which is to be shown at `now`. With `may_lock` false nothing new is
  // held and feet are released; once the offset has decayed the pose is not changed. Returns
  // whether it was.
  bool apply(MonoTime now, Pose& pose, bool may_lock = true);

  void clear();
  bool is_locked(std::size_t side) const { return feet_[side].locked; }

 private:
  // Forgets what was observed before.
  static constexpr Duration kFresh = Duration::ms(250);
  struct Foot {
    Eigen::Vector3f raw = Eigen::Vector3f::Zero();    // the ball, as it came in the last frame
    Eigen::Vector3f held = Eigen::Vector3f::Zero();   // where it is held
    Eigen::Vector3f glide = Eigen::Vector3f::Zero();  // m/s: decelerates gradually
    Spring shift;                                     // what is added to the ball
    float speed_m_s = 0.0f;
    bool locked = false;
    // From poses that arrived.
    Eigen::Vector3f seen = Eigen::Vector3f::Zero();
    float seen_speed_m_s = 0.0f;
    bool seen_standing = false;
    float seen_for_s = 0.0f;  // so
    float odds = 0.0f;        // that it stands in the next pose
  };

  void follow_floor(float low_m, float seconds);
  void follow(Foot& foot, const Eigen::Vector3f& raw, float seconds, bool may_lock);
  bool should_hold(const Foot& foot) const;
  bool should_hold_foreseen(const Foot& foot) const;
  bool is_fresh() const { return seen_at_.is_set() && time_ - seen_at_ < kFresh; }
  void move_leg(const Limb& leg, const Eigen::Vector3f& offset, Pose& pose, BodyFrames& frames);

  Settings settings_;
  Skeleton skeleton_;
  std::array<Foot, 2> feet_;
  float floor_m_ = 0.0f;  // of the balls
  Eigen::Vector3f seen_hips_ = Eigen::Vector3f::Zero();
  MonoTime time_, seen_at_, seen_capture_;
  bool began_ = false;
  bool is_foreseen_ = false;  // of the next pose
  HoldOdds hold_odds_;
  float unsure_ = 0.0f;  // and how far ahead it is: 0 … 1
};

}  // namespace dance
