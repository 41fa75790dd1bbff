// CaptureInput: a single camera or a stereo pair, by source and calibration: a camera or a video; a
// camera that delivers both views side by side; two cameras.
//
// Units/frames: pixels of one camera.
// Ownership:    owns its sources; pictures are good until the next call.
// Threads:      one owner; none inside.
// Failure:      opening names the source or the calibration, the reason and the cure.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "core/base/result.h"
#include "producers/camera/frame_source.h"
#include "producers/camera/program/capture_options.h"
#include "producers/camera/stereo/stereo_rig.h"

namespace dance {

struct CaptureFrame {
  Frame left;     // or the only one
  cv::Mat right;  // of the same moment; empty where there is none
};

class CaptureInput {
 public:
  static Result<std::unique_ptr<CaptureInput>> open(const CaptureOptions& options);
  // For a calibration to come: as the source alone says.
  static Result<std::unique_ptr<CaptureInput>> open_uncalibrated(const CaptureOptions& options);
  virtual ~CaptureInput() = default;

  virtual FrameState next(Duration timeout, CaptureFrame& out) = 0;
  virtual FrameCounters counters() const = 0;
  virtual const std::string& name() const = 0;
  // What was negotiated, in one line for people.
  virtual std::string line() const = 0;
  virtual int cameras() const = 0;
  // "" as long as all is well, else one line with the cure.
  virtual std::string trouble() const { return {}; }

  // Pictures have another size from now on, as of a camera that came back in a slower socket:
  // format() and camera() become those of it. Fails where the calibration does not fit; two cameras
  // keep their size.
  Result<void> take_size(int width_px, int height_px);

  // Of one camera.
  const FrameFormat& format() const { return format_; }
  const Pinhole& camera() const { return camera_; }
  const std::optional<StereoRig>& rig() const { return rig_; }
  // False for pictures that were chosen: no video, no camera.
  bool is_live() const { return is_live_; }

 protected:
  FrameFormat format_;
  Pinhole camera_;
  std::optional<StereoRig> rig_;
  bool is_live_ = true;
  std::string calibration_;  // file
  double fov_deg_ = 65.0;
};

}  // namespace dance
