// Picture files as the camera's programs want them: read into rows of blue, green and red, upright,
// and written from these.
//
// Units/frames: 8-bit sRGB, rows × columns × 3 bytes, blue green red as OpenCV has them.
// Ownership:    the caller's; nothing stays.
// Threads:      none inside.
// Failure:      one line with the path, the reason and the cure.
// Source:       formats/picture: PNG, JPEG and WebP; a camera's note of how it was held (Exif) is
//               followed; transparency is dropped.
#pragma once

#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <string>
#include <vector>

#include "core/base/result.h"

namespace dance {

Result<cv::Mat> read_bgr_picture(const std::string& path);

constexpr int kUsualJpegQuality = 95;
Result<std::vector<std::uint8_t>> jpeg_of_bgr(const cv::Mat& bgr, int quality = kUsualJpegQuality);
Result<std::vector<std::uint8_t>> png_of_bgr(const cv::Mat& bgr);

}  // namespace dance
