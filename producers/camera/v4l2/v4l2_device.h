// V4l2Device: an open video capture device of the kernel: its identity and its modes.
//
// Units/frames: pixels, hertz.
// Ownership:    owns the file descriptor; move only.
// Threads:      one owner.
// Failure:      open() says why not, with errno where it was the kernel's; call() returns errno, 0
//               where it went well.
// Source:       Video for Linux API, linux/videodev2.h.
#pragma once

#include <string>
#include <vector>

#include "core/base/result.h"
#include "producers/camera/v4l2/video_mode.h"

namespace dance {

struct DeviceTrouble {
  int number = 0;              // errno; 0: it was opened, but is not what was wanted
  bool is_no_capture = false;  // a video device for something else: a codec, metadata, an output
  std::string what;            // one line that names the device, the reason and the cure
};

class V4l2Device {
 public:
  static tl::expected<V4l2Device, DeviceTrouble> open(const std::string& path);
  V4l2Device(V4l2Device&& other) noexcept;
  V4l2Device& operator=(V4l2Device&& other) noexcept;
  V4l2Device(const V4l2Device&) = delete;
  V4l2Device& operator=(const V4l2Device&) = delete;
  ~V4l2Device();

  int fd() const { return fd_; }
  const std::string& path() const { return path_; }
  const std::string& card() const { return card_; }  // "HD Webcam"
  const std::string& bus_info() const {
    return bus_info_;
  }  // "usb-0000:00:14.0-1": the socket it is plugged into
  // "HD Webcam (/dev/video0)".
  std::string name() const { return card_ + " (" + path_ + ")"; }

  // Of sizes that it lets one choose freely the usual ones, the largest and what the wish asks for.
  std::vector<VideoMode> modes(const CameraWish& wish) const;

  int call(unsigned long request, void* argument) const;

 private:
  V4l2Device() = default;

  int fd_ = -1;
  std::string path_;
  std::string card_;
  std::string bus_info_;
};

// Programs that have the file open, as "firefox (1234), cheese (77)": those that this user may look
// at; "" for none.
std::string holders_of(const std::string& path);

}  // namespace dance
