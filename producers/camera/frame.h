// Frame: one picture of a camera or a video, when light fell on it, and when we had it in hand.
//
// Units/frames: rows × columns × 3 bytes, blue green red as OpenCV has them, row 0 at the top;
//               capture_time in this machine's monotonic clock (the driver's own stamp where it
//               gives one). `fetched` is of the same clock, before anything was decoded or
//               converted: what passed between the two is the camera's and the kernel's, what comes
//               after is ours.
// Ownership:    `image` shares the source's buffer: it is good until the source is asked again, and
//               is never written by who reads it.
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
  std::uint64_t sequence = 0;  // counts what the camera took, also what nobody saw
  MonoTime fetched{};  // never before capture_time, but for a file that plays faster than time
};

}  // namespace dance
