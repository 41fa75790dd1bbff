// OwnBeat: musical time for a dance whose poses carry none: from its steps, where they are steady
// and can be music's at all.
//
// Units/frames: beats of the music that is danced to here; where beat 0 lies in the bar is not
//               known, only that whole numbers are steps. Times of the poses' clock.
// Ownership:    fixed arrays; never allocates.
// Threads:      none inside; one owner.
// Failure:      nothing where the steps are not steady, or their tempo is no simple ratio of the
//               music's: such a dance is left as it is.
#pragma once

#include <complex>
#include <optional>

#include "transformers/tempo/period.h"

namespace dance {

class OwnBeat {
 public:
  void set_body(const Skeleton& skeleton) { period_.set_body(skeleton); }
  void forget();
  // Takes the pose in; its musical time when the dance has one.
  std::optional<double> observe(const Pose& pose, MonoTime now, double music_bpm);

 private:
  Period period_;
  std::complex<double> place_;  // of the steps between the period's whole beats, as a direction
  double steadiness_ = 0.0;
  double beats_per_step_ = 1.0;
  bool is_steady_ = false;
};

}  // namespace dance
