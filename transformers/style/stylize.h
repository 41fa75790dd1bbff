// stylize: how large a dance is shown, zone by zone: the sway of the hips, the swing of the arms,
// made more or less, while the mean pose and the beat stay, and feet that stand do not slide. r is
// how a joint deviates from its slow mean, p the part of it that comes again with each bar; shown
// is r + (gain − 1) (periodic · p + dynamic · (r − p)).
//
// What the session file says and what the guest says live multiply: the room's taste and the
// dancer's wish both count, and a guest who says nothing, or 1, leaves the room's as it is.
//
// Units/frames: gains 0 .. 4, 1 as danced. The bar is the music's where poses carry it, else found
//               in the motion (transformers/tempo/period.h). Hips: their tilt, and their sway over
//               the feet sideways and up and down; the legs are solved anew. Legs: steps are longer
//               or shorter, and hips go further over the feet, or less far. sample_at() has feet
//               where they stand by the newest pose, whatever moment it is asked for.
// Ownership:    about 120 kB; never allocates after construction. No delay. 3 to 6 us a pose with
//               all gains 1, 2.4 times as much else, 4 times without music (dance bench parts
//               --only style).
// Threads:      none inside; one owner.
// Failure:      with all gains 1, and feet back where they are danced, poses pass through bit for
//               bit. A style that is not valid is refused and counted. Hips come down where a leg
//               would not reach its foot any more. A jump in time starts anew: gains come in within
//               2 s; over a gap feet stay where they stand.
// Source:       Unuma et al. 1995 (periodic part), Bruderlin and Williams 1995 (gains on all
//               deviation).
#pragma once

#include <array>

#include "core/motion/leg_reach.h"
#include "transformers/style/kept_mean.h"
#include "transformers/style/motion_split.h"
#include "transformers/style/pose_filter.h"
#include "transformers/style/scaled_steps.h"
#include "transformers/tempo/period.h"

namespace dance {

class Stylize : public PoseFilter {
 public:
  // What the session file wants; time and clock of it are not looked at.
  explicit Stylize(const Style& base);

  void observe(const Pose& pose, MonoTime now) override;
  void apply(MonoTime now, Pose& pose) override;
  void set_body(const Skeleton& skeleton) override;
  void set_style(const Style& style) override;
  void set(const FlowSetting& setting) override;
  std::uint64_t refused() const override { return refused_; }
  std::uint64_t restarts() const override { return restarts_; }

  // As they are now: what was asked for is come to gradually.
  float gain(BodyZone zone) const { return gain_[static_cast<std::size_t>(zone)]; }

 private:
  // What of an addition stays in its mean: of what is added to the rest, and of what is added to
  // the bar's; at a gain of 2, so that it follows the gain at once.
  struct Bias {
    KeptMean rest, bar;
    Eigen::Vector3f value = Eigen::Vector3f::Zero();
  };

  // By how much hips are down so that legs reach: over longer steps they are heavy, and come down
  // in their own time.
  struct Drop {
    float slow_m = 0.0f, all_m = 0.0f;
    bool is_over_steps = false;
  };
  // Where feet and hips are brought to, from pose to pose.
  struct Standing {
    ScaledSteps steps;
    Drop drop;
  };

  void aim();
  void advance_gains(MonoTime now);
  double bars_of(const Pose& pose) const;
  // Returns the time since the pose before.
  double follow(const Pose& pose, const BodyFrames& frames, double bars, bool begins);
  bool is_plain() const;
  void follow_bias(const MotionSplit::Parts& parts, double dt_s);
  // How much of a zone's motion is added.
  float more_of(BodyZone zone) const;
  // What is added to the deviations at a gain of 2: to a bone's turn, to the sway.
  Eigen::Vector3f addable_turn(std::size_t bone, const MotionSplit::Parts& parts) const;
  Eigen::Vector3f addable_sway(const MotionSplit::Parts& parts) const;
  // A bone's local turn, with `more` of its motion.
  Eigen::Quaternionf turned(std::size_t bone, const MotionSplit::Parts& parts, float more) const;
  bool is_turned(std::size_t bone, const Pose& pose) const;
  void turn_bones(const MotionSplit::Parts& parts, Pose& pose) const;
  // The body with its legs as turned, under hips that tilt with them.
  BodyFrames scaled_legs(const Pose& danced, const Pose& turned,
                         const MotionSplit::Parts& parts) const;
  // What the hips sway more, in W.
  Eigen::Vector3f more_sway_m(const MotionSplit::Parts& parts, bool legs_are_turned) const;
  static void come_down(float needed_m, float by_steps_m, bool is_over_steps, float step_s,
                        Drop& drop);
  // Turns the bones, and puts hips and feet where they sway and step to; `step_s`: since the pose
  // that was shown before.
  void show(const BodyFrames& danced, const MotionSplit::Parts& parts, float step_s, Pose& pose);
  bool legs_are_scaled() const;

  Style base_, live_;
  bool is_on_ = true;
  std::array<float, kBodyZones> wanted_gain_{}, gain_{};
  float wanted_periodic_ = 1.0f, wanted_dynamic_ = 1.0f, periodic_ = 1.0f, dynamic_ = 1.0f;
  float come_in_ = 0.0f;  // 0 at the begin, 1 once the mean is known
  Skeleton skeleton_;
  Period period_;
  MotionSplit split_;
  MotionSplit::Parts parts_;
  std::array<Bias, kBoneCount> bias_;
  Bias sway_bias_;
  SwingFeet feet_;
  Standing standing_;
  MonoTime applied_, learnt_;
  std::uint64_t clock_id_ = 0;
  bool feet_begin_ = false;
  std::uint64_t refused_ = 0, restarts_ = 0;
};

}  // namespace dance
