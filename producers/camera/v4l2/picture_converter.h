// PictureConverter: a camera's bytes into the blue-green-red picture that all else here reads.
//
// Units/frames: pixels. YUYV and NV12 by BT.601 with 16…235, MJPG by JFIF (0…255), GREY as it is.
// Ownership:    owns the decompressor; the picture is the caller's and is allocated by the first
//               conversion into it only.
// Threads:      one owner.
// Failure:      make() names an encoding that it cannot read. convert() is false where bytes are
//               missing or a JPEG is cut off or broken; the picture then holds rubbish.
// Source:       libjpeg-turbo's TurboJPEG for JPEG, OpenCV's cvtColor for the rest.
#pragma once

#include <cstdint>
#include <memory>
#include <opencv2/core/mat.hpp>
#include <span>

#include "core/base/result.h"

namespace dance {

// As the driver lays its pictures out.
struct PixelLayout {
  std::uint32_t fourcc = 0;
  int width_px = 0;
  int height_px = 0;
  int row_bytes = 0;  // of the first plane, with padding; 0: without
};

class PictureConverter {
 public:
  // A JPEG that is higher than max_height_px is decoded at a half, a quarter or an eighth, the
  // first that fits (an eighth where none does); 0 for full size.
  static Result<PictureConverter> make(const PixelLayout& layout, int max_height_px = 0);
  PictureConverter(PictureConverter&&) noexcept;
  PictureConverter& operator=(PictureConverter&&) noexcept;
  ~PictureConverter();

  bool convert(std::span<const std::uint8_t> bytes, cv::Mat& bgr);

  // Of the converted pictures, as far as the layout determines it.
  int width_px() const;
  int height_px() const;

 private:
  class Jpeg;

  PictureConverter(const PixelLayout& layout, std::unique_ptr<Jpeg> jpeg);

  PixelLayout layout_;
  std::unique_ptr<Jpeg> jpeg_;  // for MJPG and JPEG only
};

}  // namespace dance
