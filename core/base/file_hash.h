// FileHash: the SHA-256 of a file's bytes, which names the file in messages, on the wire and in the
// store of avatars. core/store/sha256.h computes it.
//
// Ownership: plain value, no allocation.
// Threads:   none inside.
// Failure:   parse_file_hash() returns nullopt for anything but 64 hexadecimal digits.
#pragma once

#include <algorithm>
#include <array>
#include <compare>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace dance {

struct FileHash {
  std::array<std::uint8_t, 32> bytes{};

  bool is_set() const {
    return std::any_of(bytes.begin(), bytes.end(), [](std::uint8_t byte) { return byte != 0; });
  }
  bool operator==(const FileHash&) const = default;
  auto operator<=>(const FileHash&) const = default;
};

inline std::string hex_of(const FileHash& hash) {
  constexpr std::string_view kDigits = "0123456789abcdef";
  std::string text;
  for (const std::uint8_t byte : hash.bytes) {
    text += kDigits[byte >> 4];
    text += kDigits[byte & 15];
  }
  return text;
}

inline std::optional<FileHash> parse_file_hash(std::string_view text) {
  FileHash hash;
  if (text.size() != 2 * hash.bytes.size()) return std::nullopt;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    unsigned digit = 0;
    if (c >= '0' && c <= '9')
      digit = static_cast<unsigned>(c - '0');
    else if (c >= 'a' && c <= 'f')
      digit = static_cast<unsigned>(c - 'a') + 10u;
    else
      return std::nullopt;
    hash.bytes[i / 2] = static_cast<std::uint8_t>(hash.bytes[i / 2] << 4 | digit);
  }
  return hash;
}

}  // namespace dance
