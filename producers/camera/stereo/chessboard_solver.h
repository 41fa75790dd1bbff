// From corners of a chessboard in several views to a calibration, and how far it can be trusted.
//
// Units/frames: as chessboard_calibration.h.
// Ownership:    plain values.
// Threads:      none inside.
// Failure:      an Error with the cure where what comes out is no camera.
#pragma once

#include "producers/camera/stereo/chessboard_calibration.h"

namespace dance {

struct BoardCorners {
  BoardShape board;
  cv::Size picture;
  std::vector<std::vector<cv::Point2f>>
      views[2];  // of the left or only camera, and of the right one
};

Result<CalibrationReport> solve_chessboard(const BoardCorners& corners);

}  // namespace dance
