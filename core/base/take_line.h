// Reads a text line by line, without copies.
//
// Ownership: views of the caller's text.
// Threads:   none inside.
// Failure:   none; the last line need not end in a line break.
#pragma once

#include <algorithm>
#include <string_view>

namespace dance {

// Removes the first line and its line break (LF or CR LF) from `text` and returns it.
inline std::string_view take_line(std::string_view& text) {
  std::string_view line = text.substr(0, text.find('\n'));
  text.remove_prefix(std::min(text.size(), line.size() + 1));
  if (line.ends_with('\r')) line.remove_suffix(1);
  return line;
}

}  // namespace dance
