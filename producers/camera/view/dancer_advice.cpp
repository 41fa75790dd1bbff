#include "producers/camera/view/dancer_advice.h"

#include <algorithm>

#include "formats/camera_view/body_in_frame.h"
#include "producers/camera/seen_body.h"

namespace dance {
namespace {

constexpr Duration kLasts = Duration::ms(1500);
constexpr int kBlack = 16;  // of 255: video's black, or noise of a covered sensor

// Every 16th pixel of every 16th row will do.
bool is_dark(const cv::Mat& picture) {
  std::size_t sum = 0;
  std::size_t count = 0;
  for (int y = 0; y < picture.rows; y += 16) {
    const std::uint8_t* row = picture.ptr<std::uint8_t>(y);
    for (int x = 0; x < picture.cols; x += 16, ++count)
      sum += std::max({row[3 * x], row[3 * x + 1], row[3 * x + 2]});
  }
  return count > 0 && sum < count * kBlack;
}

}  // namespace

DancerAdvice::View DancerAdvice::view_of(const cv::Mat& picture, const BodyLandmarks& body) const {
  if (!body.found) return is_dark(picture) ? View::kDark : View::kNobody;
  const BodyInFrame parts = body_in_frame(seen_body(body, picture.size()));
  // The network draws what it does not see too: a head above the picture, legs behind a table.
  if (seen(parts.head) != PartSeen::kSeen) return View::kNoHead;
  const PartSeen feet = seen(parts.feet);
  if (feet == PartSeen::kCutOff) return View::kNoFeet;
  const bool has_legs = feet == PartSeen::kSeen && seen(parts.knees) != PartSeen::kHidden;
  return has_legs ? View::kWhole : View::kNoLegs;
}

std::string_view DancerAdvice::see(const cv::Mat& picture, const BodyLandmarks& body) {
  const View view = view_of(picture, body);
  if (view != view_ || !since_.is_set()) {
    view_ = view;
    since_ = body.capture_time;
  }
  // Improvements at once, problems when they last.
  const bool is_due = view == View::kWhole || body.capture_time - since_ >= kLasts;
  if (!is_due || (view == said_ && has_said_)) return "";
  said_ = view;
  has_said_ = true;
  switch (view) {
    case View::kWhole:
      return "the dancer is seen from head to feet";
    case View::kNobody:
      return "nobody is seen; step into the picture, two to four metres from the camera";
    case View::kDark:
      return "the picture is dark; is the lens covered, or the light off?";
    case View::kNoHead:
      return "the head is not in the picture; step back, or tilt the camera up";
    case View::kNoLegs:
      return "something hides the legs; clear the space before the dancer";
    case View::kNoFeet:
      return "the feet are not in the picture; step back, or tilt the camera down";
  }
  return "";
}

}  // namespace dance
