// StepDancers: real dancers who step to a song, for the evaluation of a tracker that hears of their
// steps: takes of couples whose beats were found from both partners' steps, danced one beat of the
// take on each beat of the song and over again, and seen by the same code as in a house.
//
// Units/frames: song seconds; steps a minute.
// Ownership:    StepDancers refers to the takes, which must outlive it.
// Threads:      none inside; one owner.
// Failure:      load_step_takes() names the file that cannot be read.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/base/beat.h"
#include "core/base/result.h"
#include "producers/music/beat_grid.h"
#include "producers/music/tracker/tempo/steps_hint.h"
#include "research/rhythm/untagged_takes.h"
#include "transformers/tempo/room_steps.h"

namespace dance {

using StepTakes = std::vector<UntaggedTake>;
// The second half of the files are the partners of the first, in the same order.
Result<std::shared_ptr<const StepTakes>> load_step_takes(const std::vector<std::string>& files);

// A couple in the house of the tracker.
class StepDancers {
 public:
  // The couple-th of the takes' couples, from the first again after the last.
  StepDancers(const StepTakes& takes, std::size_t couple);

  // They dance until this second of the song; `told` is what the tracker says now. True when their
  // steps were judged anew: hint() is what is heard of them.
  bool dance_until(double song_s, const BeatGrid& song, double speed, double start_s,
                   const Beat& told);
  TempoHint hint() const { return hint_.at(now_); }

 private:
  static constexpr double kPose_hz = 60.0;
  static constexpr int kPosesAJudgement = 15;

  const UntaggedTake* partners_[2];
  RoomSteps room_;
  StepsHint hint_;
  MonoTime now_;
  int poses_ = 0;
  Pose pose_;
};

}  // namespace dance
