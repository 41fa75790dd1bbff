// StepScoreBoard: where the bus thread leaves the beat scores of the dancers captured in this
// house, and the drawing thread finds them. Each pose is counted there, also where pictures are
// slower than poses.
//
// Ownership: fixed arrays; never allocates after construction.
// Threads:   on_*() on the bus thread; find() on the drawing thread.
// Failure:   a dancer beyond kMostDancers has no score until another was silent for 10 s. Poses and
//            beats of other clocks are ignored.
#pragma once

#include "core/base/guest_id.h"
#include "core/base/latest.h"
#include "viewer/practice/step_score.h"

namespace dance {

class StepScoreBoard {
 public:
  static constexpr std::size_t kMostDancers = 4;

  explicit StepScoreBoard(std::uint64_t clock_id) : clock_id_(clock_id) {}

  void on_beat(const Beat& beat) {
    if (beat.clock_id == clock_id_) music_.hear(beat);
  }
  // A pose captured in this house.
  void on_pose(const GuestId& guest, const Pose& pose, MonoTime now);
  void on_skeleton(const GuestId& guest, const Skeleton& skeleton, MonoTime now);

  struct Of {
    GuestId guest;
    MonoTime heard;
    StepScore::Figures figures;
  };
  // Returns the score of this guest or, if none is named, of the first by id. nullopt: no capture
  // has arrived in this house for some seconds.
  std::optional<Of> find(const std::optional<GuestId>& guest, MonoTime now);

 private:
  using All = std::array<Of, kMostDancers>;

  std::optional<std::size_t> place_of(const GuestId& guest, MonoTime now);

  std::uint64_t clock_id_;
  BeatClock music_;
  std::array<StepScore, kMostDancers> scores_{};  // of all_
  All all_{};
  Latest<All> latest_;
  All shown_{};  // the drawing thread's
};

}  // namespace dance
