// Words of a line of a script and what can be read from them.
//
// Units/frames: those of the line.
// Ownership:    views of the caller's text.
// Threads:      none inside.
// Failure:      errors name the word and the cure.
#pragma once

#include <charconv>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/result.h"

namespace dance::test_xr {

using Words = std::vector<std::string_view>;

inline Words split_words(std::string_view line, std::string_view separators) {
  Words words;
  while (true) {
    const auto begin = line.find_first_not_of(separators);
    if (begin == std::string_view::npos) return words;
    line.remove_prefix(begin);
    words.push_back(line.substr(0, line.find_first_of(separators)));
    line.remove_prefix(words.back().size());
  }
}

inline Result<double> read_number(std::string_view word) {
  double value = 0.0;
  const auto [stop, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc() || stop != word.data() + word.size() || !std::isfinite(value))
    return fail("'" + std::string(word) + "' is not a number; write one as 0.25");
  return value;
}

// All words from `first` on, which have to be so many numbers.
inline Result<std::vector<double>> read_numbers(const Words& words, std::size_t first,
                                                std::size_t count, const char* rule) {
  if (words.size() != first + count) return fail(std::string("write ") + rule);
  std::vector<double> values;
  for (std::size_t i = first; i < words.size(); ++i) {
    DANCE_TRY(const double value, read_number(words[i]));
    values.push_back(value);
  }
  return values;
}

}  // namespace dance::test_xr
