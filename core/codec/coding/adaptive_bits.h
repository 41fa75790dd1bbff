// Adaptive binary coding over the range coder: BitEncoder and BitDecoder adapt alike from the same
// bits. Both have the same functions, which take the value to write and return the value written or
// read, so that one template describes a format for both ends; a decoder ignores the value.
//
// Units/frames: probabilities in 1/2^16.
// Ownership:    tables belong to the caller; the coders look at the caller's bytes; no heap.
// Threads:      none inside.
// Failure:      as core/codec/coding/range_coder.h.
// Source:       binary context modelling as in LZMA and H.264's CABAC.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include "core/codec/coding/range_coder.h"

namespace dance {

// Probability of one bit: adapts quickly at first, then over the last hundred or so.
class AdaptiveBit {
 public:
  static constexpr int kBits = 16;
  static constexpr std::uint32_t kWhole = 1u << kBits;

  // Probability of 1, never 0 or certain.
  std::uint32_t probability() const { return likelihood_; }
  void learn(bool bit) {
    constexpr int kSlowest = 7;
    constexpr std::uint32_t kLeast = 1u << kSlowest;
    constexpr std::array<std::uint8_t, 24> kShift{1, 2, 2, 3, 3, 3, 3, 4, 4, 4, 4, 4,
                                                  4, 4, 5, 5, 5, 5, 5, 5, 5, 5, 6, 6};
    const int shift = seen_ < kShift.size() ? kShift[seen_] : seen_ < 60 ? 6 : kSlowest;
    seen_ = static_cast<std::uint8_t>(std::min(seen_ + 1, 60));
    if (bit)
      likelihood_ += (kWhole - likelihood_) >> shift;
    else
      likelihood_ -= likelihood_ >> shift;
    likelihood_ = std::clamp(likelihood_, kLeast, kWhole - kLeast);
  }

 private:
  std::uint32_t likelihood_ = kWhole / 2;
  std::uint8_t seen_ = 0;
};

// The bits of a number below 1 << kDepth, from the highest down, each in the context of those above
// it.
template <int kDepth>
using AdaptiveTree = std::array<AdaptiveBit, 1u << kDepth>;

class BitEncoder {
 public:
  explicit BitEncoder(std::span<std::uint8_t> out) : range_(out) {}

  bool bit(AdaptiveBit& state, bool value) {
    likely_bit(state.probability(), value);
    state.learn(value);
    return value;
  }
  // A bit of fixed probability, 0 < ones < AdaptiveBit::kWhole.
  bool likely_bit(std::uint32_t ones, bool value) {
    if (value)
      range_.encode(0, ones, AdaptiveBit::kBits);
    else
      range_.encode(ones, AdaptiveBit::kWhole - ones, AdaptiveBit::kBits);
    return value;
  }
  std::uint32_t raw(std::uint32_t value, int bits) {
    range_.encode_bits(value, bits);
    return value;
  }
  template <std::size_t kSize>
  std::uint32_t tree(std::array<AdaptiveBit, kSize>& nodes, std::uint32_t value) {
    for (std::size_t half = kSize / 2, node = 1; half > 0; half /= 2)
      node = 2 * node + (bit(nodes[node], (value & half) != 0) ? 1 : 0);
    return value;
  }

  std::size_t finish() { return range_.finish(); }
  bool ok() const { return range_.ok(); }

 private:
  RangeEncoder range_;
};

class BitDecoder {
 public:
  explicit BitDecoder(std::span<const std::uint8_t> in) : range_(in) {}

  bool bit(AdaptiveBit& state, bool /*value*/) {
    const bool value = likely_bit(state.probability(), false);
    state.learn(value);
    return value;
  }
  bool likely_bit(std::uint32_t ones, bool /*value*/) {
    const bool value = range_.decode_target(AdaptiveBit::kBits) < ones;
    if (value)
      range_.consume(0, ones);
    else
      range_.consume(ones, AdaptiveBit::kWhole - ones);
    return value;
  }
  std::uint32_t raw(std::uint32_t /*value*/, int bits) { return range_.decode_bits(bits); }
  template <std::size_t kSize>
  std::uint32_t tree(std::array<AdaptiveBit, kSize>& nodes, std::uint32_t /*value*/) {
    std::size_t node = 1;
    while (node < kSize) node = 2 * node + (bit(nodes[node], false) ? 1 : 0);
    return static_cast<std::uint32_t>(node - kSize);
  }

  bool is_exhausted() const { return range_.is_exhausted(); }

 private:
  RangeDecoder range_;
};

}  // namespace dance
