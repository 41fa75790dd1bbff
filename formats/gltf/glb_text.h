// A stranger's text as one line that may be printed: names and messages of files.
//
// Threads: none inside.
// Failure: none; what is no plain text (core/base/text/plain_text.h) becomes '?', what is too long
//          is cut.
#pragma once

#include <string>
#include <string_view>

#include "core/base/printable.h"
#include "core/base/text/cut_text.h"
#include "core/base/text/plain_text.h"

namespace dance {

inline std::string plain_line(std::string_view text, std::size_t most) {
  std::string line = plain_text(cut_text(text, most));
  while (!line.empty() && (line.back() == '?' || line.back() == ' ')) line.pop_back();
  return text.size() > most ? line + "..." : line;
}

inline std::string plain_name(std::string_view text) {
  constexpr std::size_t kLongestName = 64;
  return plain_line(text, kLongestName);
}

// A node's name, in any script. Callers that print it pass it through plain_name().
inline std::string node_name(std::string_view text) {
  constexpr std::size_t kLongestName_bytes = 200;
  return plain_text(cut_text(text, kLongestName_bytes));
}

}  // namespace dance
