// DepthHint: the dancer's distance, measured by a stereo camera.
//
// Units/frames: metres along the camera's z (C of producers/camera/pinhole.h), of the point midway
//               between the hips.
// Ownership:    plain value.
// Threads:      none inside.
// Failure:      `joints` is 0 where nothing could be matched; the rest is then not valid.
#pragma once

namespace dance {

struct DepthHint {
  double hips_depth_m = 0.0;
  double spread_m = 0.0;      // standard error of hips_depth_m
  double scale = 1.0;         // the dancer's true size over that of the network's metres
  double scale_spread = 0.0;  // its standard error; infinite where depth alone is known
  int joints = 0;             // matched and agreeing
};

}  // namespace dance
