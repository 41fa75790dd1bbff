// FrameSource: a source of pictures: a V4L2 camera, a video file, a folder of images. The newest
// picture wins: older ones that still wait when the source is read are dropped and counted.
//
// Units/frames: pixels; hertz.
// Ownership:    the source owns its buffers; a Frame borrows one until the next call.
// Threads:      one owner; none inside.
// Failure:      opening names the device or file, the reason and the cure. Later trouble is a
//               state, not an error: a camera that was unplugged is looked for until it is back, a
//               damaged picture is counted and left out.
#pragma once

#include <cstdint>
#include <string>

#include "core/base/time.h"
#include "producers/camera/frame.h"

namespace dance {

enum class FrameState {
  kFrame,  // `out` is the newest picture
  kNone,   // nothing within the timeout
  kGone,   // the camera is unplugged; call again, it may come back
  kBack,   // it is plugged in again: trackers have to be reset; the next call gives pictures
  kOver,   // the file has ended
};

struct FrameFormat {
  int width_px = 0;
  int height_px = 0;
  double hz = 0.0;       // as negotiated or as the file says
  std::string encoding;  // "YUYV", "MJPG", "NV12", or what the file holds
};

struct FrameCounters {
  std::uint64_t taken = 0;      // given to the caller
  std::uint64_t outrun = 0;     // waited behind a newer one, dropped
  std::uint64_t lost = 0;       // gaps in the driver's sequence
  std::uint64_t damaged = 0;    // the driver or the decoder said so
  std::uint64_t unplugged = 0;  // times that the device went away
};

class FrameSource {
 public:
  virtual ~FrameSource() = default;
  // Waits at most `timeout`.
  virtual FrameState next(Duration timeout, Frame& out) = 0;
  virtual const FrameFormat& format() const = 0;
  virtual const FrameCounters& counters() const = 0;
  // As a person would call it: "HD Webcam (/dev/video0)", "taiji.mp4".
  virtual const std::string& name() const = 0;
};

}  // namespace dance
