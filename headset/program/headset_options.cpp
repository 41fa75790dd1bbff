#include "headset/program/headset_options.h"

#include <cmath>
#include <numbers>

#include "core/base/comma_numbers.h"
#include "core/pose/pose.h"

namespace dance {

Result<XrSpot> parse_spot(const std::string& text) {
  const auto wrong = [&] {
    return fail("'" + text + "': write X,Z or X,Z,HEADING, in metres and degrees, as 0,1.5,180");
  };
  const auto read = comma_numbers(text);
  if (!read || read->size() < 2 || read->size() > 3) return wrong();
  const std::vector<float>& numbers = *read;
  for (const float number : numbers)
    if (std::abs(number) > kMaxStageDistance_m) return wrong();
  XrSpot spot{numbers[0], numbers[1], 0.0f};
  if (numbers.size() == 3) spot.heading_rad = numbers[2] * std::numbers::pi_v<float> / 180.0f;
  return spot;
}

}  // namespace dance
