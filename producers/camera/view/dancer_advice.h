// DancerAdvice: tells the dancer in plain words what the camera misses: a covered lens, nobody in
// the picture, feet or hands cut off. Once a state has lasted, and once when it is over; never a
// line for every picture.
//
// Units/frames: times of the pictures.
// Ownership:    allocates nothing in see().
// Threads:      none inside.
// Failure:      none.
#pragma once

#include <opencv2/core/mat.hpp>
#include <string_view>

#include "core/base/time.h"
#include "producers/camera/body_landmarks.h"

namespace dance {

class DancerAdvice {
 public:
  // What is to be said now; "" mostly. The text lives for ever.
  std::string_view see(const cv::Mat& picture, const BodyLandmarks& body);

 private:
  enum class View { kWhole, kNobody, kDark, kNoFeet };
  View view_of(const cv::Mat& picture, const BodyLandmarks& body) const;

  View said_ =
      View::kNobody;  // what the dancer was last told; nobody is there before the first picture
  View view_ = View::kNobody;
  MonoTime since_;  // view_ is so since then
  bool has_said_ = false;
};

}  // namespace dance
