// The letters of names in windows. DejaVu Sans has all of them.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

namespace dance {

struct LetterRange {
  std::uint16_t first, last;
};
// Latin, Greek and Cyrillic, dashes and quotation marks.
constexpr std::array<LetterRange, 4> kDrawnLetters{
    {{0x0020, 0x024f}, {0x0370, 0x052f}, {0x2010, 0x2026}, {0x20ac, 0x20ac}}};

constexpr bool is_drawn_letter(std::uint32_t code) {
  return std::ranges::any_of(kDrawnLetters, [&](const LetterRange& range) {
    return code >= range.first && code <= range.last;
  });
}

}  // namespace dance
