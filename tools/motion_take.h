// MotionTake: a recorded dance as stations are judged on: poses at a steady rate, stamped as if they had been captured.
//
// Units/frames: as core/pose/clip.h; capture times are 1/hz apart, from 1 s on; clock 1.
// Ownership:    plain values.
// Threads:      none inside; reads files on the caller's thread.
// Failure:      an Error names the file and the cure.
#pragma once

#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/pose/pose.h"
#include "core/pose/skeleton.h"

namespace dance {

struct MotionTake {
  std::string name;
  Skeleton skeleton;
  double hz = 60.0;
  std::vector<Pose> poses;
};

// Every n-th frame of the file, where n brings its rate nearest to hz.
Result<MotionTake> load_motion_take(const std::string& path, double hz = 60.0);

}  // namespace dance
