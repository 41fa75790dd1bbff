// Takes a turned square out of a picture, as the networks want to see it: rows of red, green, blue
// in a range of their own, read between the pixels in single precision. OpenCV's own warp rounds
// places to 1/32 pixel, which shows in the landmarks.
//
// Units/frames: places in pixels, (0, 0) the left upper corner of the left upper pixel, whose
//               middle is (0.5, 0.5).
// Ownership:    reads the picture, writes the caller's numbers; allocates nothing.
// Threads:      none inside.
// Failure:      none; the picture has three bytes a pixel and at least one pixel.
#pragma once

#include <opencv2/core/mat.hpp>
#include <span>

#include "producers/camera/body_landmarks.h"

namespace dance {

enum class Beyond { kBlack, kNearest };  // what stands beyond the picture

// The square region as size_px rows and columns; 0…255 becomes least…most.
void sample_region(const cv::Mat& blue_green_red, const BodyRegion& region, int size_px,
                   Beyond beyond, float least, float most, std::span<float> red_green_blue);

}  // namespace dance
