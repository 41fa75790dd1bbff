// The skeleton drawn over the picture that it was seen in: for setting up a camera, and for
// recordings.
//
// Units/frames: landmarks in pixels of the picture that is drawn on; blue green red.
// Ownership:    writes into the caller's picture.
// Threads:      none inside.
// Failure:      none; points outside the picture are cut off.
#pragma once

#include <opencv2/core/mat.hpp>
#include <string_view>
#include <vector>

#include "producers/camera/body_landmarks.h"

namespace dance {

// The dancer's left side is drawn warm, the right side cool; what is barely visible is pale.
void draw_landmarks(cv::Mat& picture, const BodyLandmarks& body);

// The inner corners of a chessboard, row by row; nothing where there are none.
void draw_board(cv::Mat& picture, int columns, int rows, const std::vector<cv::Point2f>& corners);

// A line of text at the lower edge, on a dark band.
void draw_caption(cv::Mat& picture, std::string_view text);

}  // namespace dance
