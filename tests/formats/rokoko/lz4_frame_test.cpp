#include "formats/lz4/lz4_frame.h"

#include <gtest/gtest.h>

#include <string>

#include "core/base/random.h"
#include "tests/allocation_guard.h"

namespace dance {
namespace {

constexpr std::size_t kMost = 100'000;

std::string text_of(std::size_t size) {
  Random random(5);
  std::string text;
  while (text.size() < size) text += std::to_string(random.uniform(-1.0, 1.0)) + ",";
  text.resize(size);
  return text;
}

std::vector<std::uint8_t> packed(const std::string& text) {
  Lz4Packer packer(text.size());
  const auto frame = packer.pack(text, text.size() + 1000);
  return {frame->begin(), frame->end()};
}

TEST(Lz4Frames, GiveBackWhatWentIn) {
  for (const std::size_t size : {std::size_t{0}, std::size_t{1}, std::size_t{5000}, kMost}) {
    const std::string text = text_of(size);
    const auto frame = packed(text);
    EXPECT_TRUE(begins_as_lz4_frame(frame));
    Lz4Unpacker unpacker(kMost);
    EXPECT_EQ(unpacker.unpack(frame), text) << size;
  }
}

// Bytes 6 to 13 of a frame with the flag 8: what Unity's plugin makes room for.
TEST(Lz4Frames, SayHowLongTheTextIs) {
  const auto frame = packed(text_of(5000));
  ASSERT_GT(frame.size(), 14u);
  EXPECT_NE(frame[4] & 8, 0);
  EXPECT_EQ(frame[6] + 256 * frame[7], 5000);
}

TEST(Lz4Frames, GiveNoMoreThanTheBoundHoweverMuchTheyHold) {
  const auto bomb = packed(std::string(std::size_t{64} << 20, 'x'));
  EXPECT_LT(bomb.size(), 400'000u);
  Lz4Unpacker unpacker(kMost);
  EXPECT_EQ(unpacker.unpack(bomb), std::nullopt);
  EXPECT_EQ(unpacker.unpack(packed(text_of(kMost + 1))), std::nullopt);
  EXPECT_EQ(unpacker.unpack(packed(text_of(kMost))), text_of(kMost));
}

TEST(Lz4Frames, RefuseEachPrefixAndWhatFollowsAFrame) {
  auto frame = packed(text_of(3000));
  Lz4Unpacker unpacker(kMost);
  for (std::size_t size = 0; size < frame.size(); ++size)
    EXPECT_EQ(unpacker.unpack(std::span(frame).first(size)), std::nullopt) << size;
  frame.push_back(0);
  EXPECT_EQ(unpacker.unpack(frame), std::nullopt);
}

TEST(Lz4Frames, StayWithinTheirBoundForEachFlippedBit) {
  const auto frame = packed(text_of(2000));
  Lz4Unpacker unpacker(kMost);
  for (std::size_t bit = 0; bit < 8 * frame.size(); ++bit) {
    auto damaged = frame;
    damaged[bit / 8] ^= static_cast<std::uint8_t>(1u << bit % 8);
    EXPECT_LE(unpacker.unpack(damaged).value_or("").size(), kMost);
  }
  EXPECT_EQ(unpacker.unpack(frame), text_of(2000));
}

TEST(Lz4Frames, AreRefusedWhereTheyBecomeTooLong) {
  Lz4Packer packer(5000);
  EXPECT_FALSE(packer.pack(text_of(5000), 100).has_value());
  EXPECT_FALSE(packer.pack(text_of(200'000), 1'000'000).has_value());
}

TEST(Lz4Frames, ArePackedWithoutAllocating) {
  const std::string text = text_of(5000);
  Lz4Packer packer(text.size());
  const AllocationGuard guard;
  for (int i = 0; i < 10; ++i) EXPECT_TRUE(packer.pack(text, 5000).has_value());
  EXPECT_EQ(guard.allocations(), 0u);
}

}  // namespace
}  // namespace dance
