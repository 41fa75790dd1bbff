// Takes of somebody who stands about, looks round, turns on the spot and walks a few steps: made,
// as recorded dances have none of it, and dancers do it before and between the songs.
//
// Units/frames: as core/pose/pose.h; the floor at 0.
// Ownership:    plain values.
// Threads:      none inside.
// Failure:      none.
#pragma once

#include "core/base/random.h"
#include "research/predict/predict_takes.h"

namespace dance {

// Of a body of average proportions. The same random numbers give the same take.
PredictTake standing_take(float height_m, double hz, double seconds, Random& random);

}  // namespace dance
