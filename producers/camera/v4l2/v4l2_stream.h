// V4l2Stream: a camera that is streaming: what was negotiated, its buffers, and the pictures in
// them as the driver left them.
//
// Units/frames: pixels, hertz; stamps as the driver gives them.
// Ownership:    owns the device and its mapped buffers. A RawPicture's bytes are the driver's
//               memory: good until give_back().
// Threads:      one owner.
// Failure:      start() names the device, the reason and the cure. A device that went away is
//               kGone, and stays so.
// Source:       Video for Linux API, streaming I/O with memory mapping.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/base/time.h"
#include "producers/camera/v4l2/picture_converter.h"
#include "producers/camera/v4l2/v4l2_device.h"
#include "producers/camera/v4l2/video_mode.h"

namespace dance {

struct RawPicture {
  std::span<const std::uint8_t> bytes;
  std::uint32_t index = 0;     // of the buffer, for give_back()
  std::uint32_t sequence = 0;  // the driver's own count
  MonoTime stamp;
  bool is_stamp_monotonic = false;
  bool is_damaged = false;  // the driver says so
};

class V4l2Stream {
 public:
  enum class Ready { kYes, kNo, kGone };

  static Result<V4l2Stream> start(V4l2Device device, const CameraWish& wish);
  V4l2Stream(V4l2Stream&&) noexcept;
  ~V4l2Stream();

  // Waits for a picture, at most `timeout`.
  Ready wait(Duration timeout) const;
  // The oldest picture that waits; kNo: none does.
  Ready take(RawPicture& out);
  void give_back(const RawPicture& picture);

  const V4l2Device& device() const { return device_; }
  // What the driver made of it.
  const VideoMode& mode() const { return mode_; }
  const PixelLayout& layout() const { return layout_; }
  int buffer_count() const { return static_cast<int>(buffers_.size()); }
  bool holds_the_rate() const {
    return holds_the_rate_;
  }  // exposure may not slow it down in the dark

 private:
  explicit V4l2Stream(V4l2Device device) : device_(std::move(device)) {}
  Result<void> negotiate(const CameraWish& wish);
  Result<void> map_buffers();
  void hold_the_rate();
  void stop();

  V4l2Device device_;
  VideoMode mode_;
  PixelLayout layout_;
  std::vector<std::span<std::uint8_t>> buffers_;
  int troubles_ = 0;
  bool is_gone_ = false;
  bool is_streaming_ = false;
  bool holds_the_rate_ = false;
  bool must_give_the_rate_free_ = false;  // as it was found
};

}  // namespace dance
