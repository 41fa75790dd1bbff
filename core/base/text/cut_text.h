// The longest beginning of a text that fits a number of bytes and ends between UTF-8 characters.
#pragma once

#include <cstddef>
#include <string_view>

namespace dance {

constexpr std::string_view cut_text(std::string_view text, std::size_t most_bytes) {
  if (text.size() <= most_bytes) return text;
  std::size_t end = most_bytes;
  for (std::size_t back = 0; back < 3 && end > 0; ++back, --end)
    if ((static_cast<unsigned char>(text[end]) & 0xc0u) != 0x80u) return text.substr(0, end);
  return text.substr(0, end);
}

}  // namespace dance
