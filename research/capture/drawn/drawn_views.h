// A recorded dance, drawn as two webcams see it, before the real pose network: what the network
// makes of each picture, with the truth beside it.
//
// Units/frames: as research/capture/several_eval.h.
// Ownership:    plain values.
// Threads:      the one that calls; makes an OpenGL context of its own.
// Failure:      names what is missing: a driver, the networks, a folder that cannot be written.
#pragma once

#include <string>

#include "core/base/result.h"
#include "producers/camera/estimator/pose_estimator.h"
#include "research/capture/several_eval.h"
#include "research/codec_takes.h"

namespace dance {

struct DrawnWishes {
  std::string take;    // a recorded dance; the salsa dancer where there is none
  std::string folder;  // keeps the pictures in first/ and second/ of it, and takes those
                       // that are there; "": does neither
  double seconds = 20.0;
  double distance_m = 3.0;
  double around_deg = 60.0;
  double later_ms = 23.0;
  std::string guest = "alice";  // whose looks the dancer has
  PoseNetworkModel model = PoseNetworkModel::kFull;
};

// `seen` of 100 pictures had the dancer found in them, of both cameras.
struct DrawnStage {
  SeveralStage stage;
  double seen_percent = 0.0;
};
Result<DrawnStage> draw_stage(const DrawnWishes& wishes);

}  // namespace dance
