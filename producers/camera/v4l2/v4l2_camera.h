// V4l2Camera: a camera of the kernel's as a FrameSource. The newest picture wins, stamps are the
// driver's, and a camera that was unplugged is looked for until it is back, in any socket and under
// any number.
//
// Units/frames: pixels; capture times are the driver's stamps where it stamps by the monotonic
//               clock, else when the picture was fetched.
// Ownership:    owns the device, its buffers and the pictures that frames share; one that is still
//               held is not overwritten.
// Threads:      one owner; none inside.
// Failure:      open() names the device, the reason and the cure. Later: see FrameSource.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/base/time.h"
#include "producers/camera/frame_source.h"
#include "producers/camera/picture_pool.h"
#include "producers/camera/v4l2/camera_list.h"
#include "producers/camera/v4l2/picture_converter.h"
#include "producers/camera/v4l2/v4l2_stream.h"
#include "producers/camera/v4l2/video_mode.h"

namespace dance {

struct CameraTimeouts {
  Duration look_every = Duration::s(1);      // for a camera that is unplugged
  Duration stalled_after = Duration::s(10);  // a camera without pictures for so long is reopened
};

class V4l2Camera : public FrameSource {
 public:
  // `called`: "/dev/video0", "0", "HD Webcam" or a part of it; "" for the first camera.
  static Result<std::unique_ptr<V4l2Camera>> open(const std::string& called,
                                                  const CameraWish& wish = {},
                                                  const CameraTimeouts& timeout = {});

  FrameState next(Duration timeout, Frame& out) override;
  const FrameFormat& format() const override { return format_; }
  const FrameCounters& counters() const override { return counters_; }
  const std::string& name() const override { return name_; }

  // One line for people: what was asked for, what was made of it, whose stamps.
  std::string negotiated() const;
  // False as soon as a picture came without a plausible driver timestamp: it and all after it
  // are stamped when fetched, until the camera is reopened. Times never go back.
  bool has_driver_stamps() const { return has_driver_stamps_; }

 private:
  V4l2Camera(const CameraWish& wish, const CameraTimeouts& timeout)
      : wish_(wish), timeouts_(timeout) {}
  Result<void> start(const std::string& path);
  FrameState look_again(MonoTime deadline);
  void lose();
  bool take_newest(RawPicture& newest);
  bool is_stale(const RawPicture& picture, MonoTime now) const;
  bool is_stalled(MonoTime now) const;
  bool show(const RawPicture& picture, Frame& out);
  void count(const RawPicture& picture);

  CameraWish wish_;
  CameraTimeouts timeouts_;
  CameraEntry identity_;                     // by which it is found again
  std::vector<std::string> others_;          // sockets of other cameras of its name
  std::optional<V4l2Stream> stream_;         // empty: the camera is gone
  std::optional<PictureConverter> convert_;  // with the stream
  PicturePool pictures_;
  FrameFormat format_;
  FrameCounters counters_;
  std::string name_;
  MonoTime shown_time_;  // of the picture given out last
  MonoTime look_at_;
  MonoTime alive_at_;           // when something last came
  std::uint64_t sequence_ = 0;  // of the newest picture, over all times that it was unplugged
  std::optional<std::uint32_t> driver_sequence_;  // of the newest picture since it streams
  int waited_ = 0;                                // pictures that waited when last asked
  bool is_refreshing_ = false;                    // what waited was stale; what comes next is taken
  bool has_driver_stamps_ = true;
};

}  // namespace dance
