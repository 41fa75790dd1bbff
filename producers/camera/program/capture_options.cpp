#include "producers/camera/program/capture_options.h"

#include <charconv>
#include <cmath>

namespace dance {

Result<std::pair<int, int>> parse_pair(const std::string& option, const std::string& text) {
  const char* const end = text.data() + text.size();
  int first = 0;
  int second = 0;
  const auto [x, error] = std::from_chars(text.data(), end, first);
  if (error == std::errc() && x != end && (*x == 'x' || *x == 'X')) {
    const auto [rest, second_error] = std::from_chars(x + 1, end, second);
    if (second_error == std::errc() && rest == end && first > 0 && second > 0 && first <= 16384 &&
        second <= 16384)
      return std::pair{first, second};
  }
  return fail(option + " '" + text + "': write two numbers with an x between them");
}

Result<CameraWish> camera_wish(const CaptureOptions& options) {
  CameraWish wish;
  if (!options.size.empty()) {
    DANCE_TRY(const auto size, parse_pair("--size", options.size));
    wish.width_px = size.first;
    wish.height_px = size.second;
  }
  if (options.hz > 0.0) wish.hz = options.hz;
  wish.encoding = options.encoding;
  // The network looks at 256 × 256: what is larger than full HD only takes time to unpack.
  wish.max_height_px = 1242;
  return wish;
}

Result<FollowOptions> follow_options(const CaptureOptions& options, int width_px, int height_px) {
  FollowOptions follow;
  if (options.follow.empty()) return follow;
  if (options.follow == "largest") {
    follow.choice = FollowOptions::Choice::kLargest;
    return follow;
  }
  const char* const end = options.follow.data() + options.follow.size();
  float x = 0.0f;
  float y = 0.0f;
  const auto [comma, error] = std::from_chars(options.follow.data(), end, x);
  if (error == std::errc() && comma != end && *comma == ',') {
    const auto [rest, y_error] = std::from_chars(comma + 1, end, y);
    if (y_error == std::errc() && rest == end && x >= 0.0f && x <= 1.0f && y >= 0.0f && y <= 1.0f) {
      follow.choice = FollowOptions::Choice::kNearest;
      follow.place_px = {x * static_cast<float>(width_px), y * static_cast<float>(height_px)};
      return follow;
    }
  }
  return fail("--follow '" + options.follow +
              "': write largest, or a place as shares of the picture, across and down: 0.3,0.5");
}

}  // namespace dance
