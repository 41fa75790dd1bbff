// Recorded dances as prediction is trained and judged on: poses at a steady rate as they were, and
// as a trembling sensor would have seen them.
//
// Units/frames: as core/pose/clip.h; capture times count from `begin`, 1/hz apart.
// Ownership:    plain values.
// Threads:      none inside; reads files on the caller's thread.
// Failure:      an Error names the file and the cure.
#pragma once

#include <string>
#include <vector>

#include "core/base/random.h"
#include "core/base/result.h"
#include "core/pose/clip.h"

namespace dance {

struct PredictTake {
  std::string name;
  Skeleton skeleton;
  double hz = 60.0;
  std::vector<Pose> poses;
};

Result<PredictTake> load_predict_take(const std::string& path, double hz);

// Each bone turned by sd_deg about each axis, the hips moved by 3 mm for half a degree, anew in
// each frame.
std::vector<Pose> trembling(const std::vector<Pose>& poses, double sd_deg, Random& random);

// Left and right exchanged.
PredictTake mirrored(const PredictTake& take);

}  // namespace dance
