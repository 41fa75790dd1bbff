// CaptureCheck: `dance capture --check`: how the camera sees a dancer who has not begun yet. No bus
// and no guest: small pictures with what is seen in them, to a program that reads them (a window
// with a preview), or the advice that follows from them as lines of text. A camera that cannot be
// opened is tried again each second, so that its trouble is over as soon as it is mended.
//
// Units/frames: as formats/camera_view/camera_view.h; at most ten views a second.
// Ownership:    owns camera and networks; borrows the descriptor that it writes to.
// Threads:      one. Call from main before other threads start.
// Failure:      open() refuses a terminal for bytes. run() fails where no picture ever came, by the
//               trouble's own line. Without the pose network pictures come without bodies.
#pragma once

#include <memory>
#include <opencv2/core/mat.hpp>

#include "core/net/poller.h"
#include "producers/camera/advice/camera_advice.h"
#include "producers/camera/check/newest_record.h"
#include "producers/camera/check/view_shake.h"
#include "producers/camera/estimator/pose_estimator.h"
#include "producers/camera/program/capture_input.h"

namespace dance {

class CaptureCheck {
 public:
  static Result<std::unique_ptr<CaptureCheck>> open(const CaptureOptions& options);
  // Until it is stopped, its reader is gone, or the video is over.
  Result<void> run();

 private:
  explicit CaptureCheck(const CaptureOptions& options) : options_(options) {}
  void open_estimator();
  void try_camera(MonoTime now);
  bool take_picture(MonoTime now);  // false once the video is over
  void look(const Frame& frame, MonoTime now);
  void count(MonoTime now);
  PreviewPicture make_small(const cv::Mat& picture);
  void set_state(CameraState state, CameraCause cause, const std::string& words);
  void tell(const CameraFacts& facts, const PreviewPicture& picture, MonoTime now);
  void print_news();
  void print_numbers() const;

  CaptureOptions options_;
  std::unique_ptr<Poller> poller_;
  std::unique_ptr<NewestRecord> out_;  // null: text
  std::unique_ptr<PoseEstimator> estimator_;
  std::string network_trouble_;
  std::unique_ptr<CaptureInput> input_;
  CameraStatus status_;
  std::string trouble_;  // of the camera, as it was said last
  CameraFacts facts_;    // newest
  ViewShake shake_;
  CameraAdvice advice_;
  std::vector<Text> printed_;
  cv::Mat small_, rgb_, luma_;
  MonoTime next_try_, next_view_, next_count_, last_picture_, end_;
  std::uint64_t counted_ = 0;   // of the camera's pictures, at the last count
  std::uint64_t pictures_ = 0;  // that were looked at
  std::uint64_t bodies_ = 0;
};

}  // namespace dance
