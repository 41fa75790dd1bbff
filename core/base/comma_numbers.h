// Numbers with commas between them, as a place on the floor is written: "0,1.5,180".
//
// Units/frames: those of the numbers.
// Ownership:    returns a new list.
// Threads:      any.
// Failure:      nullopt where a word is no finite number, or one is missing.
#pragma once

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <string_view>
#include <vector>

namespace dance {

inline std::optional<std::vector<float>> comma_numbers(std::string_view text) {
  std::vector<float> numbers;
  for (std::size_t from = 0; from <= text.size();) {
    const std::size_t comma = std::min(text.find(',', from), text.size());
    float number = 0.0f;
    const auto [end, error] = std::from_chars(text.data() + from, text.data() + comma, number);
    if (error != std::errc() || end != text.data() + comma || !std::isfinite(number))
      return std::nullopt;
    numbers.push_back(number);
    from = comma + 1;
  }
  return numbers;
}

}  // namespace dance
