// What a network of tracked bodies is trained with: dances on bodies of many proportions, and
// sequences of them as worn devices see them: some points only, each a little off, lost at times.
//
// Units/frames: rows as producers/trackers/net/tracker_features.h; TrackerRow::kStep_hz frames a
//               second.
// Ownership:    plain values.
// Threads:      none inside; const use from any.
// Failure:      none.
#pragma once

#include <vector>

#include "core/base/random.h"
#include "producers/trackers/net/tracker_features.h"
#include "research/trackers/human_take.h"

namespace dance {

struct TrackerDance {
  float height_m = 0.0f;
  std::vector<BodyFrames> frames;
  std::vector<std::array<bool, 2>> stands;
};

// The take and its mirror image, on so many bodies each, at several speeds.
std::vector<TrackerDance> tracker_dances(const PredictTake& take, int bodies, Random& random);

// Rows of `steps` frames from `first`: inputs of each, outputs of the frame after it; rows are
// `inputs_wide` and `outputs_wide` apart.
void draw_tracker_sequence(const TrackerDance& dance, std::size_t first, std::size_t steps,
                           Random& random, float* inputs, std::size_t inputs_wide, float* outputs,
                           std::size_t outputs_wide);

}  // namespace dance
