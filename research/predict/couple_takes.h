// Recorded couples: two dancers of one dance, as partner-aware prediction is judged on them.
//
// Units/frames: as research/predict/predict_takes.h; both dancers' poses of the same moments.
// Ownership:    plain values.
// Threads:      none inside.
// Failure:      an Error names the files that do not belong together.
#pragma once

#include <array>
#include <vector>

#include "research/predict/predict_takes.h"

namespace dance {

using CoupleTake = std::array<PredictTake, 2>;

// Takes in pairs: lead, follow, lead, follow. Each pair is cut to the shorter one.
Result<std::vector<CoupleTake>> couples_of(std::vector<PredictTake> takes);

// Motion capture that was put onto bodies of other proportions holds hands at 20 cm: palms that
// come within join_m of each other are brought together by the arms, nearer the nearer they are.
void join_palms(CoupleTake& couple, float join_m);

}  // namespace dance
