// CaptureProgram: `dance capture`: opens camera, pose network, solver and bus, and runs pictures
// through them until it is stopped or the video is over.
//
// Units/frames: as the parts say.
// Ownership:    owns all parts.
// Threads:      one for all of it; preview and recording have one of their own each. Call from main
//               before other threads start.
// Failure:      open() names the part that is missing, the reason and the cure. Later a camera may
//               be unplugged and come back: that is logged, and waited for.
#pragma once

#include <memory>

#include "core/bus/bus.h"
#include "core/control/house_publisher.h"
#include "core/net/poller.h"
#include "producers/camera/program/capture_chain.h"
#include "producers/camera/program/capture_input.h"
#include "producers/camera/program/capture_options.h"
#include "producers/camera/program/capture_recording.h"
#include "producers/camera/stereo/stereo_rig.h"
#include "producers/camera/view/dancer_advice.h"
#include "producers/camera/view/preview.h"

namespace dance {

class CaptureProgram {
 public:
  static Result<std::unique_ptr<CaptureProgram>> open(const CaptureOptions& options);
  // Until it is over; prints what was counted.
  void run();

 private:
  explicit CaptureProgram(const CaptureOptions& options) : options_(options) {}
  Result<void> open_chain();
  Result<void> open_extras();
  void say_what_runs() const;
  void make_solvers();
  std::string names() const;  // "alice and bob"
  bool has_usual_size(const cv::Mat& picture);
  void look(const CaptureFrame& seen);
  void say_trouble(MonoTime now);
  void report() const;

  CaptureOptions options_;
  std::vector<WishedDancer> dancers_;
  std::unique_ptr<Poller> poller_;
  std::unique_ptr<CaptureInput> input_;
  std::unique_ptr<Bus> bus_;
  std::unique_ptr<HousePublisher> port_;
  std::unique_ptr<PortCaptureSink> bus_sink_;
  std::unique_ptr<CaptureRecording> recording_;
  Extras extras_;
  std::unique_ptr<OtherCameras> others_;
  std::unique_ptr<CaptureChain> chain_;
  std::unique_ptr<Preview> preview_;
  DancerAdvice advice_;
  MonoTime begin_;
  MonoTime end_;
  MonoTime last_picture_;
  MonoTime next_look_at_trouble_;
  bool has_said_silence_ = false;
  bool has_said_gone_ = false;
  bool has_said_size_ = false;
  bool has_said_recording_ = false;
  bool has_said_preview_ = false;
  bool has_said_input_ = false;
  bool has_said_stereo_ = false;
};

}  // namespace dance
