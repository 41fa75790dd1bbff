#include "core/codec/coding/symbol_distribution.h"

#include <cmath>

namespace dance {
namespace {

void encode_distance(std::uint32_t distance, RangeEncoder& out) {
  const std::uint64_t value = std::uint64_t{distance} + 1;
  const int bits = static_cast<int>(std::bit_width(value)) - 1;
  for (int i = 0; i < bits; ++i) out.encode_bits(1, 1);
  out.encode_bits(0, 1);
  out.encode_bits(static_cast<std::uint32_t>(value & ((std::uint64_t{1} << bits) - 1)), bits);
}

std::uint32_t decode_distance(RangeDecoder& in) {
  int bits = 0;
  while (in.decode_bits(1) != 0)
    if (++bits > 31) return UINT32_MAX;  // beyond any valid number
  return static_cast<std::uint32_t>((std::uint64_t{1} << bits) + in.decode_bits(bits) - 1);
}

}  // namespace

void SymbolDistribution::encode_rest(const Symbol& symbol, RangeEncoder& out) const {
  const std::int64_t value = static_cast<std::int64_t>(symbol.n) >> shift_;
  if (symbol.slot == 0)
    encode_distance(static_cast<std::uint32_t>(first_ - 1 - value), out);
  else if (symbol.slot == kSlots - 1)
    encode_distance(static_cast<std::uint32_t>(value - first_ - 2 * kWindow - 1), out);
  if (shift_ > 0) out.encode_bits(static_cast<std::uint32_t>(symbol.n), shift_);
}

std::int32_t SymbolDistribution::decode_rest(int slot, RangeDecoder& in) const {
  std::int64_t symbol = first_ + slot - 1;
  if (slot == 0)
    symbol = first_ - 1 - static_cast<std::int64_t>(decode_distance(in));
  else if (slot == kSlots - 1)
    symbol = first_ + 2 * kWindow + 1 + static_cast<std::int64_t>(decode_distance(in));
  std::int64_t n = symbol * (std::int64_t{1} << shift_);
  if (shift_ > 0) n += in.decode_bits(shift_);
  return to_32(n);
}

double SymbolDistribution::bits_outside(const Symbol& symbol) const {
  const std::int64_t value = static_cast<std::int64_t>(symbol.n) >> shift_;
  const std::int64_t distance =
      symbol.slot == 0 ? first_ - 1 - value : value - first_ - 2 * kWindow - 1;
  return 2.0 * std::log2(static_cast<double>(distance) + 1.0) + 1.0;
}

}  // namespace dance
