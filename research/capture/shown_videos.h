// What the pose network makes of a video, and of one picture of it that is held still before a
// sensor with noise.
//
// Units/frames: as producers/camera/body_landmarks.h.
// Ownership:    plain values.
// Threads:      none inside; reads files on the caller's thread.
// Failure:      an Error names the file, the network or the frame that is missing.
#pragma once

#include <string>
#include <vector>

#include "core/base/result.h"
#include "producers/camera/body_landmarks.h"
#include "producers/camera/pinhole.h"

namespace dance {

struct VideoLandmarks {
  double hz = 30.0;
  Pinhole camera;
  std::vector<BodyLandmarks> frames;  // as the solver gets them: not smoothed
};

Result<VideoLandmarks> video_landmarks(const std::string& path);
// The frame `index`, `count` times at 30 Hz; `noise` levels of 255 are the sensor's.
Result<VideoLandmarks> still_landmarks(const std::string& path, std::uint64_t index,
                                       std::size_t count, double noise);

}  // namespace dance
