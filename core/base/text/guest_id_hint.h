// A guest id for a person's name as people write it: "jose" for "José", "anna-maria" for
// "Anna Maria". For suggestions in error messages: no name is changed silently.
//
// Failure: a name without Latin letters or digits has no suggestion: "".
#pragma once

#include <algorithm>
#include <cstdint>
#include <string>
#include <string_view>

#include "core/base/guest_id.h"

namespace dance {

// The ASCII letters for a Latin letter of U+00C0 to U+017F; "" for a sign that is no letter.
inline std::string_view ascii_of_latin(char32_t letter) {
  static constexpr std::string_view kLetters =
      "aaaaaaaceeeeiiiidnooooo.ouuuuyts"   // U+00C0
      "aaaaaaaceeeeiiiidnooooo.ouuuuyty"   // U+00E0
      "aaaaaaccccccccddddeeeeeeeeeegggg"   // U+0100
      "gggghhhhiiiiiiiiiiiijjkkklllllll"   // U+0120
      "lllnnnnnnnnnoooooooorrrrrrssssss"   // U+0140
      "ssttttttuuuuuuuuuuuuwwyyyzzzzzzs";  // U+0160
  static_assert(kLetters.size() == 0x180 - 0xC0);
  switch (letter) {
    case 0x00C4:
    case 0x00E4:
    case 0x00C6:
    case 0x00E6:
      return "ae";
    case 0x00D6:
    case 0x00F6:
    case 0x0152:
    case 0x0153:
      return "oe";
    case 0x00DC:
    case 0x00FC:
      return "ue";
    case 0x00DF:
      return "ss";
    case 0x00DE:
    case 0x00FE:
      return "th";
    default:
      break;
  }
  if (letter < 0xC0 || letter >= 0x180 || letter == 0x00D7 || letter == 0x00F7) return "";
  return kLetters.substr(letter - 0xC0, 1);
}

inline std::string suggested_guest_id(std::string_view name) {
  std::string id;
  bool is_gap = false;
  const auto add = [&](std::string_view letters) {
    if (is_gap && !id.empty()) id += '-';
    is_gap = false;
    id += letters;
  };
  for (std::size_t i = 0; i < name.size() && id.size() < kMaxGuestIdLength; ++i) {
    const auto byte = static_cast<unsigned char>(name[i]);
    const bool has_next = i + 1 < name.size() && (name[i + 1] & 0xC0) == 0x80;
    if ((byte >= 'a' && byte <= 'z') || (byte >= '0' && byte <= '9')) {
      add(name.substr(i, 1));
    } else if (byte >= 'A' && byte <= 'Z') {
      const char lower = static_cast<char>(byte - 'A' + 'a');
      add({&lower, 1});
    } else if (byte >= 0xC3 && byte <= 0xCD && has_next) {  // two bytes of UTF-8
      const char32_t letter = static_cast<char32_t>((byte & 0x1Fu) << 6 | (name[++i] & 0x3Fu));
      const bool is_accent = letter >= 0x300 && letter < 0x370;  // of the letter before
      const std::string_view ascii = ascii_of_latin(letter);
      if (!ascii.empty())
        add(ascii);
      else if (!is_accent)
        is_gap = true;
    } else {
      is_gap = true;
    }
  }
  id.resize(std::min(id.size(), kMaxGuestIdLength));
  while (id.ends_with('-')) id.pop_back();
  return id;
}

// The error message for a text that GuestId::parse() refused; suggests a valid id.
inline std::string guest_id_error(std::string_view text) {
  std::string error = "'" + std::string(text) + "': " + kGuestIdRule;
  const std::string id = suggested_guest_id(text);
  return id.empty() ? error : error + "; '" + id + "' is one";
}

}  // namespace dance
