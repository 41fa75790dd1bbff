// ViewShake: how fast the camera's view itself moves, as of a camera that is held or stands on a
// dance floor: blocks of the picture beside the dancer are found again in a later picture, and the
// median of their shifts is the view's.
//
// Units/frames: picture widths a second; times of the pictures.
// Ownership:    owns two small pictures; allocates when the size changes.
// Threads:      none inside.
// Failure:      0 where too little is seen beside the dancer, as of a bare wall.
#pragma once

#include <opencv2/core/mat.hpp>
#include <vector>

#include "core/base/time.h"
#include "formats/camera_view/camera_view.h"

namespace dance {

class ViewShake {
 public:
  // `luma`: one byte a pixel. Returns the newest value.
  float see(const cv::Mat& luma, const SeenBody2d& body, MonoTime time);
  // The next picture is another view.
  void reset();

 private:
  static constexpr Duration kEvery = Duration::ms(500);
  static constexpr int kWidth_px = 160;

  float shift_px(const cv::Mat& before, const cv::Mat& now, const SeenBody2d& body);

  cv::Mat small_, reference_;
  MonoTime reference_time_;
  float shake_ = 0.0f;
  std::vector<int> across_, down_;
};

}  // namespace dance
