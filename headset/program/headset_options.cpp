#include "headset/program/headset_options.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numbers>

#include "core/pose/pose.h"

namespace dance {

Result<XrSpot> parse_spot(const std::string& text) {
  const auto wrong = [&] {
    return fail("'" + text + "': write X,Z or X,Z,HEADING, in metres and degrees, as 0,1.5,180");
  };
  std::vector<float> numbers;
  for (std::size_t from = 0; from <= text.size();) {
    const std::size_t comma = std::min(text.find(',', from), text.size());
    float number = 0.0f;
    const auto [end, error] = std::from_chars(text.data() + from, text.data() + comma, number);
    const bool is_number = error == std::errc() && end == text.data() + comma;
    if (!is_number || !(std::abs(number) <= kMaxStageDistance_m)) return wrong();
    numbers.push_back(number);
    from = comma + 1;
  }
  if (numbers.size() < 2 || numbers.size() > 3) return wrong();
  XrSpot spot{numbers[0], numbers[1], 0.0f};
  if (numbers.size() == 3) spot.heading_rad = numbers[2] * std::numbers::pi_v<float> / 180.0f;
  return spot;
}

}  // namespace dance
