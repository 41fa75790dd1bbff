#include "producers/camera/program/capture_options.h"

#include <charconv>
#include <cmath>

#include "producers/camera/people/people_tracker.h"

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

Result<std::vector<WishedDancer>> wished_dancers(const CaptureOptions& options) {
  std::vector<WishedDancer> dancers;
  for (const std::string& name : options.guests) {
    const auto guest = GuestId::parse(name);
    if (!guest) return fail("--guest '" + name + "': " + kGuestIdRule);
    for (const WishedDancer& other : dancers)
      if (other.guest == *guest) return fail("--guest names " + name + " twice");
    dancers.push_back({*guest, 0.0});
  }
  if (dancers.empty() || dancers.size() > kMostDancers)
    return fail("--guest: one camera sees 1 to " + std::to_string(kMostDancers) + " dancers");
  if (!options.heights_m.empty() && options.heights_m.size() != dancers.size())
    return fail("--height: write one for each dancer, as --guest names them; 0 is as it looks");
  for (std::size_t i = 0; i < options.heights_m.size(); ++i)
    dancers[i].height_m = options.heights_m[i];
  if (dancers.size() > 1 && !options.follow.empty())
    return fail("--follow chooses one dancer of several people; name one guest, or leave it out");
  if (dancers.size() > 1 && (!options.also.empty() || !options.right.empty()))
    return fail("several dancers are seen by one camera; leave out --also and --right");
  return dancers;
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
