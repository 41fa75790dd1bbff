// Pictures that tests draw, and the bytes that a camera would make of them by the book: written
// here again, so that nothing is compared with itself.
//
// Units/frames: pixels; blue green red.
// Ownership:    plain values.
// Threads:      none inside.
// Failure:      none.
// Source:       ITU-R BT.601, 16…235 and 16…240.
#pragma once

#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <vector>

namespace dance {

// Four patches of strong colours, and shades between.
cv::Mat drawn_colours(int width_px, int height_px);
// All of one grey: which picture this is.
cv::Mat drawn_grey(int width_px, int height_px, int level);
inline int level_of_picture(int index) { return 20 + 10 * index; }

std::vector<std::uint8_t> yuyv_of(const cv::Mat& bgr);
std::vector<std::uint8_t> nv12_of(const cv::Mat& bgr);
std::vector<std::uint8_t> jpeg_of(const cv::Mat& bgr);

// Mean absolute difference per channel.
double mean_difference(const cv::Mat& a, const cv::Mat& b);
double mean_level(const cv::Mat& picture);

}  // namespace dance
