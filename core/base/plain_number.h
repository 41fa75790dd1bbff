// A number as people write it: all digits that it needs and no zeros that say nothing; 10000000,
// not 1e+07.
//
// Units/frames: whatever the number has.
// Ownership:    returns a text of its own.
// Threads:      any.
// Failure:      none.
#pragma once

#include <array>
#include <charconv>
#include <string>

namespace dance {

inline std::string plain_number(double x) {
  std::array<char, 352> text;  // the least double is 327 characters long, 1.8e308 is 309
  const auto end =
      std::to_chars(text.data(), text.data() + text.size(), x, std::chars_format::fixed);
  return {text.data(), end.ptr};
}

}  // namespace dance
