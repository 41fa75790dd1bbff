// The name under which people see a guest: free text beside the guest's id, which stays the same.
// The only definition of a valid shown name: 1 to 40 bytes of UTF-8 without hidden characters,
// without blanks at its ends, and with at least one character that can be seen.
//
// Ownership: plain value, no allocation.
// Threads:   any.
// Failure:   parse_shown_name() returns nullopt for anything else.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

#include "core/base/fixed_string.h"
#include "core/base/text/plain_text.h"

namespace dance {

constexpr std::size_t kMaxShownNameBytes = 40;
using ShownName = FixedString<kMaxShownNameBytes>;

// The error message for a text that parse_shown_name() refused.
constexpr const char* kShownNameRule =
    "a shown name is 1 to 40 bytes of text (UTF-8) that can be seen, without control characters";

// True for spaces and for other characters without visible ink.
constexpr bool is_blank_character(std::uint32_t code) {
  constexpr std::array<std::uint32_t, 14> kBlank{0x0020, 0x00a0, 0x034f, 0x115f, 0x1160,
                                                 0x1680, 0x200c, 0x200d, 0x202f, 0x205f,
                                                 0x2800, 0x3000, 0x3164, 0xffa0};
  return std::ranges::find(kBlank, code) != kBlank.end() || (code >= 0x2000 && code <= 0x200a);
}

// Blanks at the ends are removed.
inline std::optional<ShownName> parse_shown_name(std::string_view text) {
  if (!is_plain_text(text)) return std::nullopt;
  std::size_t begin = text.size(), end = 0;
  for (std::size_t at = 0; at < text.size();) {
    const Utf8Character character = *first_character(text.substr(at));
    if (!is_blank_character(character.code)) {
      begin = std::min(begin, at);
      end = at + character.bytes;
    }
    at += character.bytes;
  }
  ShownName name;
  return begin < end && name.assign(text.substr(begin, end - begin)) ? std::optional(name)
                                                                     : std::nullopt;
}

}  // namespace dance
