// Frame: one picture of a camera or a video, when it was taken, and when it was fetched.
//
// Units/frames: rows × columns × 3 bytes, blue green red as OpenCV has them, row 0 at the top;
//               capture_time in this machine's monotonic clock (the driver's own stamp where it
//               gives one). `fetched` is of the same clock, before anything was decoded or
//               converted: the time between the two belongs to camera and kernel, the time after to
//               this program.
// Ownership:    `image` shares the source's buffer: it is valid until the source is read again, and
//               is never written by its readers.
// Threads:      none inside.
// Failure:      none.
#pragma once

#include <cstdint>
#include <opencv2/core/mat.hpp>

#include "core/base/time.h"

namespace dance {

struct Frame {
  cv::Mat image;
  MonoTime capture_time;
  std::uint64_t sequence = 0;  // counts all pictures of the camera, dropped ones too
  MonoTime fetched{};  // never before capture_time, but for a file that plays faster than time
};

}  // namespace dance
