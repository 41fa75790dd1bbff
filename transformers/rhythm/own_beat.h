// OwnBeat: musical time for a dance whose poses carry none: from its steps. Where they are those of
// salsa, a filter with a memory of some ten seconds tells the place in the bar through turns and
// figures; other steps tell the beat where they are steady for seconds and can be music's at all.
//
// Units/frames: beats of the music that is danced to here; whole numbers are steps. Salsa's bars
//               begin at multiples of four counts; of other steps it is not known where. Times of
//               the poses' clock.
// Ownership:    fixed arrays; never allocates.
// Threads:      none inside; one owner.
// Failure:      nothing where neither is sure, or the tempo is no simple ratio of the music's: such
//               a dance is left as it is.
#pragma once

#include <complex>
#include <optional>

#include "transformers/rhythm/steady_count.h"
#include "transformers/tempo/period.h"
#include "transformers/tempo/step_pointer.h"

namespace dance {

class OwnBeat {
 public:
  explicit OwnBeat(const StepPattern& steps = salsa_steps()) : pointer_(steps) {}

  void set_body(const Skeleton& skeleton) { period_.set_body(skeleton); }
  void forget();
  // Takes the pose in; its musical time when the dance has one.
  std::optional<double> observe(const Pose& pose, MonoTime now, double music_bpm);

 private:
  void follow_steps(double music_bpm);
  double steps_bpm(double music_bpm, MonoTime t);
  std::optional<double> by_period(MonoTime t, double music_bpm);

  Period period_;
  // By the filter, evenly.
  StepSigns signs_;
  StepPointer pointer_;
  SteadyCount told_;
  MonoTime told_at_, seen_, sure_, near_, looked_;
  bool is_sure_ = false;
  double own_bpm_ = 0.0;  // steps that keep a pace of their own; 0: the music's
  // By the period alone.
  std::complex<double> place_;  // of the steps between the period's whole beats, as a direction
  double steadiness_ = 0.0;
  double beats_per_step_ = 1.0;
  bool is_steady_ = false;
};

}  // namespace dance
