// DeepPicture: a picture whose copies are deep, in buffers that are reused: for the
// slots between two threads (core/base/latest.h), where an OpenCV matrix would be shared and
// overwritten.
//
// Ownership: each copy owns its pixels. What `pixels` is set to directly is shared, as OpenCV does
//            it.
// Threads:   none inside; one owner.
// Failure:   none.
#pragma once

#include <opencv2/core/mat.hpp>

namespace dance {

struct DeepPicture {
  cv::Mat pixels;

  DeepPicture() = default;
  ~DeepPicture() = default;
  DeepPicture(const DeepPicture& other) { *this = other; }
  DeepPicture& operator=(const DeepPicture& other) {
    if (this != &other) other.pixels.copyTo(pixels);
    return *this;
  }
};

}  // namespace dance
