// Recorded dances as the pose codec is trained and judged on: whole poses, at a steady rate, on the
// proportions as the tunnel carries them.
//
// Units/frames: as core/pose/clip.h says.
// Ownership:    plain values.
// Threads:      none inside; reads files on the caller's thread.
// Failure:      an Error names the file and the cure.
#pragma once

#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/pose/clip.h"

namespace dance {

struct CodecTake {
  std::string name;
  Skeleton skeleton;  // as decode_skeleton() gives it
  double hz = 60.0;
  std::vector<Pose> poses;  // normalised; sequence counts, capture times are 1/hz apart
};

// Every n-th frame of the file, where n brings its rate nearest to hz; jitter_deg turns each bone
// by a random angle of that size, as cameras do, the same each time.
Result<CodecTake> load_codec_take(const std::string& path, double hz, double jitter_deg = 0.0);
// Each of the files.
Result<std::vector<CodecTake>> load_codec_takes(const std::vector<std::string>& paths, double hz,
                                                double jitter_deg = 0.0);

}  // namespace dance
