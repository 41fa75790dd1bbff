// DancerAdvice: messages for the dancer on what the camera misses: a covered lens, nobody in the
// picture, head or feet cut off, legs hidden. Once a state has lasted, and once when it is over;
// never a line for every picture.
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
  // The message that is due now; "" mostly. Static text.
  std::string_view see(const cv::Mat& picture, const BodyLandmarks& body);

 private:
  enum class View { kWhole, kNobody, kDark, kNoHead, kNoFeet, kNoLegs };
  View view_of(const cv::Mat& picture, const BodyLandmarks& body) const;

  View said_ = View::kNobody;  // of the last message; nobody is there before the first picture
  View view_ = View::kNobody;
  MonoTime since_;  // view_ is so since then
  bool has_said_ = false;
};

}  // namespace dance
