// The golden messages, and what each must bear: written and read byte for byte, and every bit of it
// turned.
//
// Ownership: plain values.
// Threads:   none inside.
// Failure:   a test that uses it fails.
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "core/bus/encode.h"

namespace dance {

using Bytes = std::vector<std::uint8_t>;

constexpr std::uint64_t kClock = 0x0123456789abcdefULL;
constexpr MonoTime kCaptured = MonoTime::from_us(1'234'567'890'123);

inline Bytes read_golden(const std::string& type) {
  std::ifstream file(std::string(DANCE_SOURCE_DIR) + "/tests/core/bus/golden/" + type + ".bin",
                     std::ios::binary);
  EXPECT_TRUE(file.is_open()) << type;
  return Bytes(std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>());
}

template <class T>
Bytes encoded(const T& value) {
  MessageBuffer buffer;
  const std::size_t size = encode(value, buffer);
  return Bytes(buffer.begin(), buffer.begin() + static_cast<std::ptrdiff_t>(size));
}

// Writing gives the file; reading the file and writing again gives it too, so every field was read.
template <class T>
void expect_golden(const std::string& type, const T& value) {
  const Bytes golden = read_golden(type);
  EXPECT_EQ(encoded(value), golden) << type;
  T decoded;
  ASSERT_EQ(decode(golden.data(), golden.size(), decoded), Decoded::kFine) << type;
  const Bytes again = encoded(decoded);
  ASSERT_EQ(again.size(), golden.size());
  std::size_t differing = 0;
  for (std::size_t i = 0; i < golden.size(); ++i) differing += again[i] != golden[i];
  // Reading makes rotations exactly unit, which may move the last bit of 0.6 and 0.8.
  EXPECT_LE(differing, type == "pose_t" || type == "hands_t" ? 2 * kFingerBoneCount : 0u) << type;
}

template <class T>
void expect_survives_bit_flips(const std::string& type) {
  Bytes bytes = read_golden(type);
  std::size_t fine = 0, refused = 0;
  for (std::size_t bit = 0; bit < bytes.size() * 8; ++bit) {
    bytes[bit / 8] = static_cast<std::uint8_t>(bytes[bit / 8] ^ (1u << (bit % 8)));
    T value;
    const Decoded outcome = decode(bytes.data(), bytes.size(), value);
    if (bit < 64) {
      EXPECT_EQ(outcome, Decoded::kUndecodable);  // the fingerprint
    }
    ++(outcome == Decoded::kFine ? fine : refused);
    if (outcome == Decoded::kFine) encoded(value);  // what was let through can be worked with
    bytes[bit / 8] = static_cast<std::uint8_t>(bytes[bit / 8] ^ (1u << (bit % 8)));
  }
  EXPECT_GE(refused, 64u) << type;
  EXPECT_GT(fine, 0u) << type;
}

}  // namespace dance
