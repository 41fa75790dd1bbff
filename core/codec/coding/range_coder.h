// Range coder: symbols of known frequencies into nearly as few bytes as information theory allows.
// RangeEncoder writes a message, RangeDecoder reads it back; both must be given the same
// distributions in the same order. Integers only, so every machine makes the same bytes. A message
// costs less than one byte beyond its entropy, and its length must be known from its container.
//
// Units/frames: a distribution's frequencies add up to 1 << bits, bits 1 to 16; a symbol is its
//               frequency and the cumulative frequency before it.
// Ownership:    views of the caller's bytes; no heap.
// Threads:      none inside.
// Failure:      the encoder never writes past the end: ok() is false once something did not fit.
//               The decoder reads zeros beyond the end, and any bytes decode to some symbols.
// Source:       G. N. N. Martin, Range encoding, 1979; carries run into bytes already written.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>

#include "core/base/assert.h"

namespace dance {

constexpr int kMaxFrequencyBits = 16;
constexpr int kMaxRawBits = 32;

namespace detail {
// low and code are fractions of 56 bits; a byte leaves whenever the range has 48 or fewer, so that
// a frequency of 1 in 2^16 still has 32 bits to be exact in.
constexpr int kRangeTop = 56;
constexpr std::uint64_t kRangeWhole = std::uint64_t{1} << kRangeTop;
constexpr std::uint64_t kRangeLeast = kRangeWhole >> 8;
}  // namespace detail

class RangeEncoder {
 public:
  explicit RangeEncoder(std::span<std::uint8_t> out) : out_(out) {}

  // A symbol of frequency `freq` > 0 among 1 << bits, the symbols before it having `cum_low`.
  void encode(std::uint32_t cum_low, std::uint32_t freq, int bits) {
    DANCE_ASSERT(freq > 0 && cum_low + freq <= 1u << bits);
    const std::uint64_t unit = range_ >> bits;
    narrow(unit * cum_low, unit * freq);
  }

  // The n lowest bits of value, raw; n from 0 to 32.
  void encode_bits(std::uint32_t value, int n) {
    const std::uint64_t unit = range_ >> n;
    const std::uint64_t mask = (std::uint64_t{1} << n) - 1;
    narrow(unit * (value & mask), unit);
  }

  // Ends the message with as few bytes as possible and returns its length; nothing may be encoded
  // after it. 0 where it did not fit, and also for an empty message: see ok().
  std::size_t finish() {
    // The number of [low, low + range) with the most trailing zeros, which need not be written.
    if (low_ != 0 && low_ + range_ > detail::kRangeWhole) {
      carry();
    } else if (low_ != 0) {
      const std::uint64_t round = (low_ + detail::kRangeLeast - 1) / detail::kRangeLeast;
      put(static_cast<std::uint8_t>(round));
    }
    low_ = 0;
    while (ok_ && at_ > 0 && out_[at_ - 1] == 0) --at_;
    return ok_ ? at_ : 0;
  }

  bool ok() const { return ok_; }

 private:
  void narrow(std::uint64_t offset, std::uint64_t range) {
    low_ += offset;
    range_ = range;
    if (low_ >= detail::kRangeWhole) {
      carry();
      low_ -= detail::kRangeWhole;
    }
    // One byte or none, branch-free: a byte written but not counted is overwritten. More are rare.
    if (at_ < out_.size()) [[likely]] {
      const int shift = range_ < detail::kRangeLeast ? 8 : 0;
      out_[at_] = static_cast<std::uint8_t>(low_ >> (detail::kRangeTop - 8));
      at_ += static_cast<std::size_t>(shift / 8);
      low_ = low_ << shift & (detail::kRangeWhole - 1);
      range_ <<= shift;
    }
    while (range_ < detail::kRangeLeast) [[unlikely]] {
        put(static_cast<std::uint8_t>(low_ >> (detail::kRangeTop - 8)));
        low_ = low_ << 8 & (detail::kRangeWhole - 1);
        range_ <<= 8;
      }
  }
  void put(std::uint8_t byte) {
    ok_ = ok_ && at_ < out_.size();
    if (ok_) out_[at_++] = byte;
  }
  // The message is below 1, so a byte that is not 0xff is always there, unless one did not fit.
  void carry() {
    for (std::size_t i = at_; ok_ && i > 0;)
      if (++out_[--i] != 0) break;
  }

  std::span<std::uint8_t> out_;
  std::size_t at_ = 0;
  std::uint64_t low_ = 0;
  std::uint64_t range_ = detail::kRangeWhole;
  bool ok_ = true;
};

class RangeDecoder {
 public:
  explicit RangeDecoder(std::span<const std::uint8_t> in) : in_(in) {
    for (int i = 0; i < detail::kRangeTop / 8; ++i) code_ = code_ << 8 | next();
  }

  // Position of the next symbol in the distribution of 1 << bits: the symbol is the one with
  // cum_low <= target < cum_low + freq. Must be followed by consume() of it.
  std::uint32_t decode_target(int bits) {
    unit_ = range_ >> bits;
    return static_cast<std::uint32_t>(std::min(code_ / unit_, (std::uint64_t{1} << bits) - 1));
  }
  // The same without division: after begin(), is_below() edges of the distribution as needed, then
  // consume(). Malformed bytes may lie above every edge.
  void begin(int bits) { unit_ = range_ >> bits; }
  void consume(std::uint32_t cum_low, std::uint32_t freq) {
    code_ -= unit_ * cum_low;
    range_ = unit_ * freq;
    // One byte or none, branch-free; more are rare.
    const int shift = range_ < detail::kRangeLeast ? 8 : 0;
    code_ = (code_ << 8 | peek()) >> (8 - shift) & (detail::kRangeWhole - 1);
    range_ <<= shift;
    at_ += static_cast<std::size_t>(shift / 8);
    while (range_ < detail::kRangeLeast) [[unlikely]] {
        code_ = (code_ << 8 | next()) & (detail::kRangeWhole - 1);
        range_ <<= 8;
      }
  }
  std::uint32_t decode_bits(int n) {
    const std::uint32_t value = decode_target(n);
    consume(value, 1);
    return value;
  }

  // No trailing bytes: no encoder writes more than this.
  bool is_exhausted() const {
    return in_.size() + detail::kRangeTop / 8 <= at_ + 1 && (in_.empty() || in_.back() != 0);
  }

 private:
  std::uint64_t peek() const { return at_ < in_.size() ? in_[at_] : 0u; }
  std::uint64_t next() {
    const std::uint64_t byte = peek();
    ++at_;
    return byte;
  }

  std::span<const std::uint8_t> in_;
  std::size_t at_ = 0;  // of the next byte; goes on beyond the end
  std::uint64_t code_ = 0;
  std::uint64_t range_ = detail::kRangeWhole;
  std::uint64_t unit_ = 1;
};

}  // namespace dance
