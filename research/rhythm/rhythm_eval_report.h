// The report of `dance rhythm eval`: a table for people, or one JSON object.
//
// Units/frames: as the names say.
// Ownership:    plain values.
// Threads:      none inside.
// Failure:      none.
#pragma once

#include <string>

#include "research/rhythm/rhythm_eval.h"

namespace dance {

// The first runs are the baselines; the last is ours.
std::string rhythm_eval_table(const std::vector<BeatDance>& dances,
                              const std::vector<RhythmRun>& runs, bool each);
std::string rhythm_eval_json(const std::vector<BeatDance>& dances,
                             const std::vector<RhythmRun>& runs);

}  // namespace dance
