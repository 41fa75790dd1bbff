// Recorded dances put onto human bodies. The takes come on the bones of a computer figure, whose
// hips and shoulders lie elsewhere than those of people; a solver that knows people only would be
// judged by that difference. Turns stay as they were danced; the dance grows or shrinks with the
// legs, and the balls of the feet keep their path.
//
// Units/frames: as core/pose/pose.h; the floor at 0.
// Ownership:    plain values.
// Threads:      none inside; load_human_takes reads files on the caller's thread.
// Failure:      an Error names the file and the cure.
#pragma once

#include <string>
#include <vector>

#include "core/base/random.h"
#include "core/base/result.h"
#include "research/predict/predict_takes.h"

namespace dance {

// A body of this height whose segments differ from the average as people's do: each by a normal
// share of `spread`, both sides alike.
Skeleton human_skeleton(float height_m, float spread, Random& random);

// The take on this body.
PredictTake on_body(const PredictTake& take, const Skeleton& body);

// Height of the dancer of a take: taller for the lead, as recorded.
float dancer_height_m(const PredictTake& take);

// At another rate, on a cubic.
PredictTake at_rate(const PredictTake& take, double hz);

}  // namespace dance
