// Dancer: a producer of poses that is asked for the pose of a moment: a recorded clip, the
// synthetic salsa dancer. producers/producer_program.h, or the house that hosts it, paces and
// publishes it.
//
// Units/frames: t counts from the dancer's start; poses in W, metres.
// Ownership:    the caller owns the dancer.
// Threads:      none inside; one owner.
// Failure:      none: whatever can fail fails when the dancer is made.
#pragma once

#include "core/base/time.h"
#include "core/pose/pose.h"
#include "core/pose/skeleton.h"

namespace dance {

class Dancer {
 public:
  virtual ~Dancer() = default;
  virtual const Skeleton& skeleton() const = 0;
  // Frames a second at which this dancer is best sampled.
  virtual double natural_hz() const = 0;
  // Fills rotations, hips, presence, confidence and musical time; sequence, clock and stamps are
  // the caller's.
  virtual void dance_at(Duration t, Pose& out) = 0;
  // The fingers at t; false where this dancer has none.
  virtual bool hands_at(Duration, Hands&) { return false; }
  // True while its steps are shifted to the music that this house hears: they then give no evidence
  // of that music's beat.
  virtual bool is_moved_to_music(Duration) const { return false; }
  // True when there is nothing left to play.
  virtual bool is_over(Duration) const { return false; }
};

}  // namespace dance
