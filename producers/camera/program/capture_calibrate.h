// `dance capture --calibrate FILE`: measures a lens, or two cameras, with a chessboard that is
// shown to the camera, and prints what is still to be shown until there is enough.
//
// Units/frames: as ChessboardCalibration.
// Ownership:    nothing is kept.
// Threads:      one; call from main.
// Failure:      what cannot be opened, solved or written, with the cure. A file that is there is
//               replaced only by a whole new one.
#pragma once

#include "producers/camera/program/capture_options.h"

namespace dance {

Result<void> calibrate_camera(const CaptureOptions& options);

}  // namespace dance
