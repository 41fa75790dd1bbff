// Texts from outside as people may see them: valid UTF-8 without characters that act on the display
// instead of showing something. Titles, file names, device names and messages pass through here
// before a terminal, a window or a log shows them.
//
// Hidden characters are: control characters (C0, C1, DEL), line and paragraph separators, and the
// format controls of Unicode, among them all that change the direction of text. Not hidden are the
// joiners U+200C and U+200D, which many scripts need, and visible signs of category Cf.
//
// Threads: any.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace dance {

struct Utf8Character {
  std::uint32_t code = 0;
  std::size_t bytes = 0;
};

// The character that the text begins with; nullopt where its bytes are no UTF-8 or it is empty.
constexpr std::optional<Utf8Character> first_character(std::string_view text) {
  const auto byte = [&](std::size_t i) {
    return i < text.size() ? static_cast<unsigned char>(text[i]) : 0u;
  };
  if (text.empty()) return std::nullopt;
  const unsigned first = byte(0);
  if (first < 0x80) return Utf8Character{first, 1};
  if (first < 0xc2 || first > 0xf4) return std::nullopt;
  const std::size_t more = first >= 0xf0 ? 3 : first >= 0xe0 ? 2 : 1;
  std::uint32_t code = first & (0x3fu >> more);
  for (std::size_t i = 1; i <= more; ++i) {
    if ((byte(i) & 0xc0u) != 0x80u) return std::nullopt;
    code = code << 6 | (byte(i) & 0x3fu);
  }
  constexpr std::array<std::uint32_t, 4> kLeast{0, 0x80, 0x800, 0x10000};
  const bool is_surrogate = code >= 0xd800 && code < 0xe000;
  if (code < kLeast[more] || code > 0x10ffff || is_surrogate) return std::nullopt;
  return Utf8Character{code, more + 1};
}

constexpr bool is_hidden_character(std::uint32_t code) {
  struct Range {
    std::uint32_t first, last;
  };
  constexpr std::array<Range, 16> kHidden{{
      {0x0000, 0x001f},    // C0
      {0x007f, 0x009f},    // DEL, C1
      {0x00ad, 0x00ad},    // soft hyphen
      {0x061c, 0x061c},    // Arabic letter mark
      {0x180e, 0x180e},    // Mongolian vowel separator
      {0x200b, 0x200b},    // zero width space
      {0x200e, 0x200f},    // left-to-right and right-to-left mark
      {0x2028, 0x202e},    // separators of lines and paragraphs; embeddings and overrides
      {0x2060, 0x206f},    // word joiner, invisible operators, isolates, deprecated controls
      {0xfeff, 0xfeff},    // byte order mark
      {0xfff9, 0xfffb},    // interlinear annotation
      {0x13430, 0x1343f},  // joiners of hieroglyphs
      {0x1bca0, 0x1bca3},  // shorthand controls
      {0x1d173, 0x1d17a},  // musical controls
      {0xe0000, 0xe007f},  // tags
      {0xe0080, 0xe00ff},  // unassigned, ignorable by default
  }};
  return std::ranges::any_of(
      kHidden, [&](const Range& range) { return code >= range.first && code <= range.last; });
}

// Whether the text is UTF-8 without hidden characters.
constexpr bool is_plain_text(std::string_view text) {
  while (!text.empty()) {
    const auto character = first_character(text);
    if (!character || is_hidden_character(character->code)) return false;
    text.remove_prefix(character->bytes);
  }
  return true;
}

// The text with '?' for each hidden character and each byte that is no UTF-8.
inline std::string plain_text(std::string_view text) {
  std::string plain;
  plain.reserve(text.size());
  while (!text.empty()) {
    const auto character = first_character(text);
    const std::size_t bytes = character ? character->bytes : 1;
    if (character && !is_hidden_character(character->code))
      plain += text.substr(0, bytes);
    else
      plain += '?';
    text.remove_prefix(bytes);
  }
  return plain;
}

}  // namespace dance
