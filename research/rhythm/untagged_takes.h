// Takes that came without their music, for evaluations of what steps alone tell: their beats found
// from each couple's steps together, laid onto a song, and for each the steps of all others.
//
// Units/frames: as research/rhythm/dance_beats.h.
// Ownership:    plain values.
// Threads:      none inside.
// Failure:      an Error names the file, or that partners are missing.
#pragma once

#include <string>
#include <vector>

#include "core/base/result.h"
#include "research/rhythm/rhythm_eval.h"

namespace dance {

struct UntaggedTake {
  CodecTake take;
  SeenSteps steps;
  DanceBeats beats;         // of the couple
  DanceBeats alone;         // by this dancer's steps alone
  std::size_t partner = 0;  // itself: none
  StepPattern others;       // learnt from all but this couple
};

// couples: the second half of the files are the partners of the first, in the same order.
Result<std::vector<UntaggedTake>> load_untagged_takes(const std::vector<std::string>& files,
                                                      bool couples, double hz);
// Takes tell what steps look like, not where the beat lies in them, as their music is lost: that is
// told by dances whose beats are known, those behind the takes.
StepPattern learn_from_all(const std::vector<UntaggedTake>& takes,
                           const std::vector<BeatDance>& dances, const BeatGrid& music);

// How far the beats agree that partners' steps tell without each other.
std::string partners_table(const std::vector<UntaggedTake>& takes);
// As transformers/tempo/step_pattern.cpp has it.
std::string pattern_text(const StepPattern& pattern);

}  // namespace dance
