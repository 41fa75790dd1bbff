// Transformer: one station of a route, pose in and pose out: hold, predict, rhythm, stylize.
// Stations of a chain know the one before them; the stage asks the last one.
//
// Units/frames: `now` is this house's clock. A pose's capture_time says which moment of the dance
//               it shows; stations may shift it, and the difference to `now` is what is still to be
//               taken back.
// Ownership:    the chain owns its stations; never allocate after construction.
// Threads:      none inside; one owner. Pure: no I/O, no clock of their own. What is too slow for
//               the pose path is in a Learner, which another thread may run.
// Failure:      sample() is false while there is nothing to show.
#pragma once

#include <cstdint>
#include <memory>

#include "core/base/beat.h"
#include "core/base/time.h"
#include "core/pose/pose.h"
#include "core/pose/skeleton.h"
#include "core/pose/style.h"
#include "transformers/predict/learner.h"

namespace dance {

class Transformer {
 public:
  struct Counters {
    std::uint64_t refused = 0;   // poses that were not newer than what was there
    std::uint64_t restarts = 0;  // the source began again: a producer came back, a replay looped
    std::uint64_t starved = 0;   // samples that had to repeat the newest pose
  };

  virtual ~Transformer() = default;
  // A pose has arrived from the route's source; every station hears of every pose.
  virtual void observe(const Pose& pose, MonoTime now) = 0;
  // The pose to show at `now`.
  virtual bool sample(MonoTime now, Pose& out) = 0;

  // Which moment of the dance sample(now) shows, in the capture clock: for a station behind that
  // makes the pose of it better than a repetition.
  virtual MonoTime moment(MonoTime now) { return input_ ? input_->moment(now) : now; }
  // The pose of a moment as far as it is known at `now`, past, under way or to come: for a station
  // behind that chooses the moment by itself. Nothing is smoothed from call to call: that is the
  // last station's part. False where this station cannot.
  virtual bool sample_at(MonoTime /*moment*/, MonoTime /*now*/, Pose& /*out*/) { return false; }

  // The music that this house hears.
  virtual void hear(const Beat& /*beat*/, MonoTime /*now*/) {}
  // The dancer's proportions, and how the dance is to be shown.
  virtual void set_body(const Skeleton& /*skeleton*/) {}
  virtual void set_style(const Style& /*style*/) {}
  virtual std::shared_ptr<Learner> learner() { return nullptr; }
  // How long after the last word of a dancer there is something of them to show. Nothing: as long
  // as anybody's silence.
  virtual Duration patience() const { return Duration(); }

  void set_input(Transformer* input) { input_ = input; }
  const Counters& counters() const { return counters_; }

 protected:
  Transformer* input_ = nullptr;  // the station before this one; null for the first
  Counters counters_;
};

}  // namespace dance
