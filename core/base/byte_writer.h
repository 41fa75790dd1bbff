// Writes little-endian numbers into the caller's buffer, never past its end.
//
// Units/frames: little-endian whatever the host.
// Ownership:    writes into the caller's bytes.
// Threads:      none inside.
// Failure:      ok() is false once a write did not fit; nothing of that write is kept.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string_view>

namespace dance {

class ByteWriter {
 public:
  explicit ByteWriter(std::span<std::uint8_t> buffer) : buffer_(buffer) {}

  void u8(std::uint8_t v) { unsigned_le<1>(v); }
  void u16(std::uint16_t v) { unsigned_le<2>(v); }
  void u24(std::uint32_t v) { unsigned_le<3>(v); }
  void u32(std::uint32_t v) { unsigned_le<4>(v); }
  void u48(std::uint64_t v) { unsigned_le<6>(v); }
  void u64(std::uint64_t v) { unsigned_le<8>(v); }
  void i16(std::int16_t v) { u16(static_cast<std::uint16_t>(v)); }
  void i32(std::int32_t v) { u32(static_cast<std::uint32_t>(v)); }
  void i64(std::int64_t v) { u64(static_cast<std::uint64_t>(v)); }
  void f64(double v) { u64(std::bit_cast<std::uint64_t>(v)); }

  void bytes(std::span<const std::uint8_t> b) {
    if (!take(b.size()) || b.empty()) return;
    std::memcpy(buffer_.data() + at_ - b.size(), b.data(), b.size());
  }
  // One byte of length, then the characters: for texts of at most 255.
  void short_text(std::string_view text) {
    u8(static_cast<std::uint8_t>(text.size()));
    bytes({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
  }

  bool ok() const { return ok_; }
  std::size_t size() const { return at_; }
  std::size_t room() const { return buffer_.size() - at_; }
  std::span<const std::uint8_t> written() const { return buffer_.first(at_); }

 private:
  bool take(std::size_t n) {
    if (!ok_ || buffer_.size() - at_ < n) {
      ok_ = false;
      return false;
    }
    at_ += n;
    return true;
  }
  template <std::size_t kBytes>
  void unsigned_le(std::uint64_t value) {
    if (!take(kBytes)) return;
    for (std::size_t i = 0; i < kBytes; ++i)
      buffer_[at_ - kBytes + i] = static_cast<std::uint8_t>(value >> (8 * i));
  }

  std::span<std::uint8_t> buffer_;
  std::size_t at_ = 0;
  bool ok_ = true;
};

}  // namespace dance
