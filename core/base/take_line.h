// Reads a text line by line where it stands.
//
// Ownership: views of the caller's text.
// Threads:   none inside.
// Failure:   none; what has no end of line is a line too.
#pragma once

#include <algorithm>
#include <string_view>

namespace dance {

// Takes the first line off `text`, and its end with it, however that is written.
inline std::string_view take_line(std::string_view& text) {
  std::string_view line = text.substr(0, text.find('\n'));
  text.remove_prefix(std::min(text.size(), line.size() + 1));
  if (line.ends_with('\r')) line.remove_suffix(1);
  return line;
}

}  // namespace dance
