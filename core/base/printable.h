// Text of a file or of the network as it may be printed: each byte that is no printable ASCII
// becomes '?', so that it moves no cursor and begins no line.
//
// Units/frames: none.
// Ownership:    returns a new text.
// Threads:      any.
// Failure:      none.
#pragma once

#include <string>
#include <string_view>

namespace dance {

inline std::string printable(std::string_view text) {
  std::string line;
  line.reserve(text.size());
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    line += byte < 0x20 || byte >= 0x7f ? '?' : c;
  }
  return line;
}

}  // namespace dance
