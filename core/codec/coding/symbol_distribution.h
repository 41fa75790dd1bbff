// Codes one whole number with predicted mean and spread under a trained distribution, in integer
// arithmetic. Numbers far from the mean cost more bits; none is clamped.
//
// Units/frames: the mean is in 1/256 of a step; a spread class c stands for 2^((c − 16) / 4) steps.
// Ownership:    refers to the table, which must outlive it.
// Threads:      none inside.
// Failure:      decode() of damaged bytes gives some number, and terminates.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>

#include "core/codec/coding/range_coder.h"

namespace dance {

constexpr int kSpreadClasses = 64;
// Mean and spread class of a distribution; classes out of range are clamped.
struct Spread {
  std::int64_t mean_256 = 0;
  int spread_class = 16;
};

// The cumulative distribution for z ≥ 0 in sixteenths of the spread: (F(z) − ½) · kTableTop · 256.
constexpr int kTableSteps = 256;
constexpr std::uint32_t kTableTop = (1u << 16) - 64;
using DistributionTable = std::array<std::uint32_t, kTableSteps + 1>;

class SymbolDistribution {
 public:
  SymbolDistribution() = default;
  [[gnu::always_inline]] SymbolDistribution(const DistributionTable& shape, Spread spread)
      : shape_(&shape) {
    const int c = std::clamp(spread.spread_class, 0, kSpreadClasses - 1);
    const std::int64_t inverse = kInverses[static_cast<std::size_t>(c)];
    first_ = ((spread.mean_256 + 128) >> 8) - kWindow;
    // A branch, so that the symbol's position does not depend on the spread.
    if (c >= kFirstShifted) [[unlikely]] {
      shift_ = (c >> 2) - 5;
      first_ = ((first_ + kWindow) >> shift_) - kWindow;
    }
    const std::int64_t middle = (first_ + kWindow) * (std::int64_t{1} << (shift_ + 8));
    edge_ = (middle - 128 - spread.mean_256) * inverse;
    width_ = inverse << (shift_ + 8);
  }

  // A number's place in the distribution.
  struct Symbol {
    std::int32_t n = 0;
    int slot = 0;
    std::uint32_t low = 0, freq = 0;
  };
  [[gnu::always_inline]] Symbol find(std::int32_t n) const {
    const std::int64_t from_first = (static_cast<std::int64_t>(n) >> shift_) - first_;
    const int slot = static_cast<int>(std::clamp<std::int64_t>(from_first + 1, 0, kSlots - 1));
    const std::uint32_t low = below(slot);
    return {n, slot, low, below(slot + 1) - low};
  }
  // As find() of the number before or after, `way` −1 or 1.
  [[gnu::always_inline]] Symbol beside(const Symbol& symbol, int way) const {
    const int slot = symbol.slot + way;
    if (shift_ > 0 || symbol.slot < 1 || symbol.slot >= kSlots - 1) return find(symbol.n + way);
    if (way < 0) {
      const std::uint32_t low = below(slot);
      return {symbol.n - 1, slot, low, symbol.low - low};
    }
    const std::uint32_t low = symbol.low + symbol.freq;
    return {symbol.n + 1, slot, low, below(slot + 1) - low};
  }
  // Direction in which numbers are cheaper: −1, 1, or 0 in the middle.
  int cheaper_way(const Symbol& symbol) const {
    return symbol.slot < kMiddleSlot ? 1 : symbol.slot > kMiddleSlot ? -1 : 0;
  }
  // Bits that encode() would write.
  [[gnu::always_inline]] double bits(const Symbol& symbol) const {
    const double bits = kFrequencyBits - nearly_log2(symbol.freq) + shift_;
    return symbol.slot != 0 && symbol.slot != kSlots - 1 ? bits : bits + bits_outside(symbol);
  }
  void encode(const Symbol& symbol, RangeEncoder& out) const {
    out.encode(symbol.low, symbol.freq, kFrequencyBits);
    if (shift_ > 0 || symbol.slot == 0 || symbol.slot == kSlots - 1) encode_rest(symbol, out);
  }
  void encode(std::int32_t n, RangeEncoder& out) const { encode(find(n), out); }

  [[gnu::always_inline]] std::int32_t decode(RangeDecoder& in) const {
    const std::uint32_t target = in.decode_target(kFrequencyBits);
    int slot = kMiddleSlot;
    std::uint32_t low = left_of_mean(slot), high;
    if (target < low) {
      do {
        high = low;
        --slot;
        low = slot > 0 ? left_of_mean(slot) : 0;
      } while (target < low);
    } else {
      while (target >=
             (high = slot + 1 < kSlots ? right_of_mean(slot + 1) : 1u << kFrequencyBits)) {
        low = high;
        ++slot;
      }
    }
    in.consume(low, high - low);
    if (shift_ > 0 || slot == 0 || slot == kSlots - 1) return decode_rest(slot, in);
    return to_32(first_ + slot - 1);
  }

 private:
  static constexpr int kFrequencyBits = 16;
  static constexpr int kWindow = 15;               // symbols either side of the mean
  static constexpr int kMiddleSlot = kWindow + 1;  // the mean lies in it
  static constexpr int kSlots = 2 * kWindow + 3;
  static constexpr int kFirstShifted = 24;  // spread class
  // Of each class's spread, 2^20 / steps.
  static constexpr auto kInverses = [] {
    constexpr std::array<std::int64_t, 4> kQuarterOctaves{1'048'576, 881'744, 741'455, 623'487};
    std::array<std::int64_t, kSpreadClasses> inverses{};
    for (std::size_t c = 0; c < inverses.size(); ++c) {
      const int octave = static_cast<int>(c >> 2) - 4;
      const std::int64_t q = kQuarterOctaves[c & 3];
      inverses[c] = octave <= 0 ? q << -octave : q >> octave;
    }
    return inverses;
  }();

  // Cumulative frequency below a slot; slots 0 and kSlots − 1 are escapes.
  [[gnu::always_inline]] std::uint32_t below(int slot) const {
    if (slot <= 0) return 0;
    if (slot >= kSlots) return 1u << kFrequencyBits;
    return inside(slot);
  }
  // Branch-free, as the side of the mean is unpredictable.
  [[gnu::always_inline]] std::uint32_t inside(int slot) const {
    const std::int64_t z = z_of(slot);
    const auto sign = static_cast<std::uint32_t>(z >> 63);
    return static_cast<std::uint32_t>(kTableTop / 2 + slot) +
           ((half(z < 0 ? -z : z) ^ sign) - sign);
  }
  std::uint32_t left_of_mean(int slot) const {
    return static_cast<std::uint32_t>(kTableTop / 2 + slot) - half(-z_of(slot));
  }
  std::uint32_t right_of_mean(int slot) const {
    return static_cast<std::uint32_t>(kTableTop / 2 + slot) + half(z_of(slot));
  }
  // The lower edge of a slot, in 1/4096 of the spread from the mean.
  std::int64_t z_of(int slot) const { return (edge_ + (slot - kMiddleSlot) * width_) >> 16; }
  // Probability between the mean and z ≥ 0.
  std::uint32_t half(std::int64_t z) const {
    const std::int64_t far = std::min<std::int64_t>(z, (kTableSteps << 8) - 1);
    const std::uint32_t* at = shape_->data() + (far >> 8);
    const auto a = static_cast<std::int32_t>(at[0]), b = static_cast<std::int32_t>(at[1]);
    return static_cast<std::uint32_t>(
        (a + (((b - a) * static_cast<std::int32_t>(far & 255)) >> 8)) >> 8);
  }
  // Within 0.002.
  static double nearly_log2(std::uint32_t x) {
    const auto bits = std::bit_cast<std::uint64_t>(static_cast<double>(x));
    const double whole = static_cast<double>(static_cast<int>(bits >> 52) - 1023);
    const double f =
        std::bit_cast<double>((bits & 0x000f'ffff'ffff'ffff) | 0x3ff0'0000'0000'0000) - 1.0;
    return whole + f + f * (1.0 - f) * (0.4233 - 0.1568 * f);
  }
  static std::int32_t to_32(std::int64_t n) {
    return static_cast<std::int32_t>(std::clamp<std::int64_t>(n, INT32_MIN / 2, INT32_MAX / 2));
  }
  // Escapes, and wide distributions: rare.
  double bits_outside(const Symbol& symbol) const;
  void encode_rest(const Symbol& symbol, RangeEncoder& out) const;
  std::int32_t decode_rest(int slot, RangeDecoder& in) const;

  const DistributionTable* shape_ = nullptr;
  std::int64_t edge_ = 0;   // the lower edge of the middle slot from the mean, 2^-28 of the spread
  std::int64_t width_ = 0;  // of a slot
  std::int64_t first_ = 0;  // symbol of slot 1
  int shift_ = 0;           // wide distributions are coded coarsely, the rest in raw bits
};

}  // namespace dance
