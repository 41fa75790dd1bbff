// Reads little-endian numbers from untrusted bytes, never past their end: a read that would sets
// the error flag and returns zeros, so a parser may read on and check ok() once.
//
// Units/frames: little-endian whatever the host.
// Ownership:    a view of the caller's bytes.
// Threads:      none inside.
// Failure:      ok() is false once a read went past the end; it stays false.
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <type_traits>

namespace dance {

class ByteReader {
 public:
  explicit ByteReader(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

  std::uint8_t u8() { return static_cast<std::uint8_t>(unsigned_le<1>()); }
  std::uint16_t u16() { return static_cast<std::uint16_t>(unsigned_le<2>()); }
  std::uint32_t u24() { return static_cast<std::uint32_t>(unsigned_le<3>()); }
  std::uint32_t u32() { return static_cast<std::uint32_t>(unsigned_le<4>()); }
  std::uint64_t u48() { return unsigned_le<6>(); }
  std::uint64_t u64() { return unsigned_le<8>(); }
  std::int16_t i16() { return static_cast<std::int16_t>(u16()); }
  std::int32_t i32() { return static_cast<std::int32_t>(u32()); }
  std::int64_t i64() { return static_cast<std::int64_t>(u64()); }
  float f32() { return std::bit_cast<float>(u32()); }
  double f64() { return std::bit_cast<double>(u64()); }

  // A view of the next n bytes; empty, and the flag set, when there are fewer.
  std::span<const std::uint8_t> bytes(std::size_t n) {
    if (!take(n)) return {};
    return bytes_.subspan(at_ - n, n);
  }
  std::string_view text(std::size_t n) {
    const auto b = bytes(n);
    return {reinterpret_cast<const char*>(b.data()), b.size()};
  }
  // A text that ends with a zero byte, which is read too; an error where none is within `longest`
  // characters.
  std::string_view text_to_zero(std::size_t longest) {
    const auto rest = bytes_.subspan(at_, std::min(remaining(), longest + 1));
    const auto end = std::find(rest.begin(), rest.end(), std::uint8_t{0});
    if (end == rest.end()) ok_ = false;
    const std::string_view read = text(static_cast<std::size_t>(end - rest.begin()));
    u8();
    return ok_ ? read : std::string_view();
  }

  bool ok() const { return ok_; }
  std::size_t remaining() const { return bytes_.size() - at_; }
  // All bytes were read, and none beyond the end.
  bool is_exhausted() const { return ok_ && at_ == bytes_.size(); }

 private:
  bool take(std::size_t n) {
    if (!ok_ || bytes_.size() - at_ < n) {
      ok_ = false;
      return false;
    }
    at_ += n;
    return true;
  }
  template <std::size_t kBytes>
  std::uint64_t unsigned_le() {
    if (!take(kBytes)) return 0;
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < kBytes; ++i)
      value |= static_cast<std::uint64_t>(bytes_[at_ - kBytes + i]) << (8 * i);
    return value;
  }

  std::span<const std::uint8_t> bytes_;
  std::size_t at_ = 0;
  bool ok_ = true;
};

}  // namespace dance
