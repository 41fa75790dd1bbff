// FNV-1a: a 64-bit checksum of bytes, the same on every machine. Not against those who want two
// texts to have the same one: core/store/sha256.h is.
//
// Units/frames: none.
// Ownership:    plain values.
// Threads:      any.
// Failure:      none.
// Source:       Fowler, Noll and Vo.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

namespace dance {

constexpr std::uint64_t kFnvBegin = 14695981039346656037u;

// Goes on where another has ended.
constexpr std::uint64_t fnv1a(std::span<const std::uint8_t> bytes, std::uint64_t sum = kFnvBegin) {
  for (const std::uint8_t byte : bytes) sum = (sum ^ byte) * 1099511628211u;
  return sum;
}
constexpr std::uint64_t fnv1a(std::string_view text, std::uint64_t sum = kFnvBegin) {
  for (const char c : text) sum = (sum ^ static_cast<unsigned char>(c)) * 1099511628211u;
  return sum;
}

// As 32 bits, to which all 64 contribute.
constexpr std::uint32_t folded(std::uint64_t sum) {
  return static_cast<std::uint32_t>(sum ^ sum >> 32);
}

}  // namespace dance
