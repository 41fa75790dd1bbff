// DancerTimeline: everything that came of one dancer, stored once for all that asks about it: the
// poses, the proportions of the body, and the beats that this house hears.
//
// Units/frames: capture times are of the dancer's clock, arrival times and beats of this house's.
// Ownership:    keeps the last poses, as many as the constructor says; never allocates after it.
// Threads:      none inside; one owner.
// Failure:      a pose that is not newer is refused and counted. A source that jumps back by more
//               than kJumpBack, or changes its clock, starts anew with that pose and is counted.
#pragma once

#include <cstdint>

#include "core/base/beat_clock.h"
#include "core/pose/history.h"
#include "core/pose/skeleton.h"

namespace dance {

class DancerTimeline {
 public:
  static constexpr Duration kJumpBack = Duration::s(1);
  enum class Taken { kRefused, kTaken, kRestarted };
  struct Counters {
    std::uint64_t refused = 0;   // poses that were not newer than what was there
    std::uint64_t restarts = 0;  // the source began again: a producer came back, a replay looped
  };

  explicit DancerTimeline(std::size_t most_poses) : poses_(most_poses), body_(average_skeleton()) {}

  Taken take(const Pose& pose, MonoTime now);
  // Returns true where the music jumped. What is no music is ignored.
  bool hear(const Beat& beat) { return is_valid(beat) && music_.hear(beat); }
  // False, and nothing is changed, where it is no skeleton.
  bool set_body(const Skeleton& skeleton);

  bool is_empty() const { return poses_.empty(); }
  const PoseHistory& poses() const { return poses_; }
  const Pose& newest() const { return poses_.newest(); }
  // When the newest pose came, how long it took since its capture, and how long before that
  // capture the previous pose's was (0 for the first).
  MonoTime arrived() const { return arrived_; }
  Duration transit() const { return arrived_ - newest().capture_time; }
  Duration gap() const { return gap_; }
  // As PoseHistory::at_for_good().
  std::optional<PoseHistory::Answer> at_for_good(MonoTime t) { return poses_.at_for_good(t); }

  const BeatClock& music() const { return music_; }
  const Skeleton& body() const { return body_; }
  const Counters& counters() const { return counters_; }

 private:
  PoseHistory poses_;
  Skeleton body_;
  BeatClock music_;
  MonoTime arrived_;
  Duration gap_;
  Counters counters_;
};

}  // namespace dance
