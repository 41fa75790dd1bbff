// A stranger's text as one line that may be printed: names and messages of files.
//
// Threads: none inside.
// Failure: none; what is not printable ASCII becomes '?', what is too long is cut.
#pragma once

#include <string>
#include <string_view>

#include "core/base/printable.h"

namespace dance {

inline std::string plain_line(std::string_view text, std::size_t most) {
  std::string line = printable(text.substr(0, most));
  while (!line.empty() && (line.back() == '?' || line.back() == ' ')) line.pop_back();
  return text.size() > most ? line + "..." : line;
}

inline std::string plain_name(std::string_view text) {
  constexpr std::size_t kLongestName = 64;
  return plain_line(text, kLongestName);
}

}  // namespace dance
