// How a picture is lit: as a whole, and a dancer beside what is around her.
//
// Units/frames: the picture blue, green, red as OpenCV has it; a body's points in shares of it.
// Ownership:    plain function; one small picture's copy inside.
// Threads:      none inside.
// Failure:      a picture without pixels is black.
#pragma once

#include <opencv2/core/mat.hpp>

#include "formats/camera_view/camera_view.h"

namespace dance {

// `luma`: one byte a pixel.
PictureLight light_of(const cv::Mat& luma, const SeenBody2d& body);

}  // namespace dance
