// A log to look at: a dance as it was danced, and what a solver made of few points of it, side by
// side.
//
// Units/frames: as core/pose/pose.h.
// Ownership:    none.
// Threads:      none inside.
// Failure:      an Error names the file.
#pragma once

#include <string>

#include "research/trackers/trackers_eval.h"

namespace dance {

// `danced`, `rules-3`, `learned-3`, `learned-4` and `learned-6`, from left to right.
Result<void> show_trackers(const PredictTake& take, const TrackerEvalOptions& options,
                           const std::string& path);

}  // namespace dance
