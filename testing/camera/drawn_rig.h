// The stereo rig that scenes are drawn with, and what a calibration would make of it.
//
// Units/frames: as producers/camera/stereo/calibration_file.h: pixels, metres.
// Ownership:    plain values.
// Threads:      any.
// Failure:      none.
#pragma once

#include <cstdint>

#include "producers/camera/stereo/rectified_pair.h"

namespace dance {

// A rig as a ZED is one: 1280 x 720 an eye, lenses of 700 pixels with distortion, 120 mm apart,
// mounted with the errors of a real one. What the scene is drawn with.
StereoRig drawn_rig();
// The same with errors of a calibration that came out with a few tenths of a pixel.
StereoRig calibrated_rig(const StereoRig& truth, std::uint64_t seed);

}  // namespace dance
