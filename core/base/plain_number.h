// A number in plain decimal notation: the digits it needs, no trailing zeros, no exponent
// (10000000, not 1e+07).
//
// Units/frames: those of the number.
// Ownership:    returns a new text.
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
