// SharedPlacement: where the camera stands, as several dancers before it have found together: they
// are on one floor, in one W.
//
// Units/frames: as camera_placement.h. W's origin is the first place of the first dancer.
// Ownership:    shared by the solvers of one camera.
// Threads:      none inside: all solvers on one thread.
// Failure:      none.
#pragma once

#include <cstdint>

#include "producers/camera/solver/camera_placement.h"

namespace dance {

struct SharedPlacement {
  CameraPlacement placement;
  std::uint64_t version = 0;  // counts its changes; 0: nobody has been seen yet
  // The dancer whose height sets the scale: one whose height was told, else the first. The others
  // are as tall as they are when they stand on this floor.
  const void* scaled_by = nullptr;
  bool is_told = false;
  double scale = 1.0;  // of all changes of the scale so far
};

}  // namespace dance
