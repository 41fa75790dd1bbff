#include "core/codec/coding/range_coder.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

#include "core/base/random.h"

namespace dance {
namespace {

struct Distribution {
  int bits = 1;
  std::vector<std::uint32_t> cum;  // one more than symbols
};

// Some distributions are flat, some give nearly everything to one symbol.
Distribution random_distribution(Random& random) {
  Distribution distribution;
  distribution.bits = 1 + static_cast<int>(random.below(kMaxFrequencyBits));
  const std::uint32_t total = 1u << distribution.bits;
  const std::uint32_t symbols = 1 + static_cast<std::uint32_t>(random.below(std::min(total, 40u)));
  std::vector<std::uint32_t> freq(symbols, 1);
  std::uint32_t left = total - symbols;
  for (std::uint32_t i = 0; i + 1 < symbols && left > 0; ++i) {
    const auto part = static_cast<std::uint32_t>(random.below(left + 1));
    freq[random.below(symbols)] += part;
    left -= part;
  }
  freq[random.below(symbols)] += left;
  distribution.cum.push_back(0);
  for (const std::uint32_t f : freq) distribution.cum.push_back(distribution.cum.back() + f);
  return distribution;
}

struct Item {
  std::size_t distribution = 0;  // index; raw bits where it is none
  std::uint32_t value = 0;
  int raw_bits = -1;
};

std::uint32_t symbol_at(const Distribution& distribution, std::uint32_t target) {
  std::uint32_t s = 0;
  while (distribution.cum[s + 1] <= target) ++s;
  return s;
}

std::vector<Item> random_items(Random& random, const std::vector<Distribution>& distributions,
                               std::size_t count) {
  std::vector<Item> items(count);
  for (Item& item : items) {
    if (random.uniform() < 0.1) {
      item.raw_bits = static_cast<int>(random.below(kMaxRawBits + 1));
      item.value = static_cast<std::uint32_t>(random.below(std::uint64_t{1} << item.raw_bits));
      continue;
    }
    item.distribution = random.below(distributions.size());
    const Distribution& distribution = distributions[item.distribution];
    // As the distribution says, and now and then what it thinks unlikely.
    item.value = random.uniform() < 0.8
                     ? symbol_at(distribution,
                                 static_cast<std::uint32_t>(random.below(1u << distribution.bits)))
                     : static_cast<std::uint32_t>(random.below(distribution.cum.size() - 1));
  }
  return items;
}

double put(RangeEncoder& encoder, const std::vector<Distribution>& distributions,
           const std::vector<Item>& items) {
  double ideal_bits = 0.0;
  for (const Item& item : items) {
    if (item.raw_bits >= 0) {
      encoder.encode_bits(item.value, item.raw_bits);
      ideal_bits += item.raw_bits;
      continue;
    }
    const Distribution& distribution = distributions[item.distribution];
    const std::uint32_t freq = distribution.cum[item.value + 1] - distribution.cum[item.value];
    encoder.encode(distribution.cum[item.value], freq, distribution.bits);
    ideal_bits += distribution.bits - std::log2(freq);
  }
  return ideal_bits;
}

TEST(RangeCoder, RoundTripsWithinOneByteOfTheEntropy) {
  Random random(1);
  std::array<std::uint8_t, 4096> bytes;
  double worst_bytes = 0.0;
  for (int round = 0; round < 4000; ++round) {
    std::vector<Distribution> distributions;
    for (int i = 0; i < 5; ++i) distributions.push_back(random_distribution(random));
    const auto items = random_items(random, distributions, random.below(200));
    RangeEncoder encoder(bytes);
    const double ideal_bytes = put(encoder, distributions, items) / 8.0;
    const std::size_t size = encoder.finish();
    ASSERT_TRUE(encoder.ok());
    worst_bytes = std::max(worst_bytes, static_cast<double>(size) - ideal_bytes);
    RangeDecoder decoder({bytes.data(), size});
    for (const Item& item : items) {
      if (item.raw_bits >= 0) {
        ASSERT_EQ(decoder.decode_bits(item.raw_bits), item.value);
        continue;
      }
      const Distribution& distribution = distributions[item.distribution];
      const std::uint32_t s = symbol_at(distribution, decoder.decode_target(distribution.bits));
      decoder.consume(distribution.cum[s], distribution.cum[s + 1] - distribution.cum[s]);
      ASSERT_EQ(s, item.value);
    }
    ASSERT_TRUE(decoder.is_exhausted());
  }
  EXPECT_LE(worst_bytes, 1.0);
}

TEST(RangeCoder, CarriesThroughWholeRunsOfOnes) {
  // The middle half again and again: the bytes written are 7f ff ff … until the end says 80 00 00.
  for (int halves = 0; halves < 400; ++halves) {
    for (std::uint32_t last = 0; last < 4; ++last) {
      std::array<std::uint8_t, 64> bytes;
      RangeEncoder encoder(bytes);
      for (int i = 0; i < halves; ++i) encoder.encode(1, 2, 2);
      encoder.encode(last, 1, 2);
      encoder.encode_bits(0x155, 9);
      const std::size_t size = encoder.finish();
      ASSERT_TRUE(encoder.ok());
      RangeDecoder decoder({bytes.data(), size});
      for (int i = 0; i < halves; ++i) {
        ASSERT_EQ((decoder.decode_target(2) + 1) / 2, 1u);
        decoder.consume(1, 2);
      }
      ASSERT_EQ(decoder.decode_bits(2), last);
      ASSERT_EQ(decoder.decode_bits(9), 0x155u);
    }
  }
}

TEST(RangeCoder, WhatIsCertainCostsNothing) {
  std::array<std::uint8_t, 4> bytes;
  RangeEncoder encoder(bytes);
  for (int i = 0; i < 1000; ++i) encoder.encode(0, 1u << 16, 16);
  EXPECT_EQ(encoder.finish(), 0u);
  EXPECT_TRUE(encoder.ok());
}

TEST(RangeCoder, NeverWritesPastTheEnd) {
  Random random(2);
  std::vector<Distribution> distributions;
  for (int i = 0; i < 5; ++i) distributions.push_back(random_distribution(random));
  for (std::size_t room = 0; room < 60; ++room) {
    std::array<std::uint8_t, 64> bytes;
    bytes.fill(0xa5);
    RangeEncoder encoder({bytes.data(), room});
    put(encoder, distributions, random_items(random, distributions, 2000));
    EXPECT_EQ(encoder.finish(), 0u);
    EXPECT_FALSE(encoder.ok());
    for (std::size_t i = room; i < bytes.size(); ++i) EXPECT_EQ(bytes[i], 0xa5);
  }
}

TEST(RangeCoder, SeesBytesBehindTheMessage) {
  std::array<std::uint8_t, 16> bytes{};
  RangeEncoder encoder(bytes);
  for (std::uint32_t i = 1; i < 6; ++i) encoder.encode_bits(i * 37, 8);
  const std::size_t size = encoder.finish();
  for (std::size_t longer = 0; longer < 4; ++longer) {
    bytes[size + longer - (longer > 0 ? 1 : 0)] = bytes[size - 1];
    RangeDecoder decoder({bytes.data(), size + longer});
    for (int i = 1; i < 6; ++i) decoder.decode_bits(8);
    EXPECT_EQ(decoder.is_exhausted(), longer == 0) << longer;
  }
}

TEST(RangeCoder, AnyBytesDecodeToSomething) {
  Random random(3);
  for (int round = 0; round < 2000; ++round) {
    std::vector<std::uint8_t> bytes(random.below(30));
    for (auto& b : bytes) b = static_cast<std::uint8_t>(random.below(4) * 85);
    const Distribution distribution = random_distribution(random);
    RangeDecoder decoder(bytes);
    for (int i = 0; i < 100; ++i) {
      const std::uint32_t target = decoder.decode_target(distribution.bits);
      ASSERT_LT(target, 1u << distribution.bits);
      const std::uint32_t s = symbol_at(distribution, target);
      decoder.consume(distribution.cum[s], distribution.cum[s + 1] - distribution.cum[s]);
      decoder.decode_bits(32);
    }
  }
}

// The bytes are a format: they do not change with the machine.
TEST(RangeCoder, MakesTheSameBytesEverywhere) {
  std::array<std::uint8_t, 32> bytes{};
  RangeEncoder encoder(bytes);
  encoder.encode(0, 1, 16);
  encoder.encode(1000, 30000, 16);
  encoder.encode_bits(0xdeadbeef, 32);
  encoder.encode(3, 5, 3);
  const std::size_t size = encoder.finish();
  EXPECT_EQ(std::vector<std::uint8_t>(bytes.begin(), bytes.begin() + size),
            (std::vector<std::uint8_t>{0x00, 0x00, 0x69, 0xd7, 0x28, 0xd7, 0x34}));
}

}  // namespace
}  // namespace dance
