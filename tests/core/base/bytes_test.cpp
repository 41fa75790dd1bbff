#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include "core/base/byte_reader.h"
#include "core/base/byte_writer.h"
#include "core/base/fixed_list.h"

namespace dance {
namespace {

void write_everything(ByteWriter& writer) {
  writer.u8(0xfe);
  writer.u16(0x1234);
  writer.u24(0xabcdef);
  writer.u32(0x89abcdef);
  writer.u48(0x123456789abcULL);
  writer.u64(0xfedcba9876543210ULL);
  writer.i16(-2);
  writer.i32(-3);
  writer.i64(-4);
  writer.f64(-0.5);
  writer.short_text("hips");
}
constexpr std::size_t kEverything_bytes = 1 + 2 + 3 + 4 + 6 + 8 + 2 + 4 + 8 + 8 + 5;

TEST(Bytes, ReadBackAsTheyWereWritten) {
  std::array<std::uint8_t, kEverything_bytes> buffer;
  ByteWriter writer(buffer);
  write_everything(writer);
  ASSERT_TRUE(writer.ok());
  EXPECT_EQ(writer.room(), 0u);

  ByteReader reader(writer.written());
  EXPECT_EQ(reader.u8(), 0xfe);
  EXPECT_EQ(reader.u16(), 0x1234);
  EXPECT_EQ(reader.u24(), 0xabcdefu);
  EXPECT_EQ(reader.u32(), 0x89abcdefu);
  EXPECT_EQ(reader.u48(), 0x123456789abcULL);
  EXPECT_EQ(reader.u64(), 0xfedcba9876543210ULL);
  EXPECT_EQ(reader.i16(), -2);
  EXPECT_EQ(reader.i32(), -3);
  EXPECT_EQ(reader.i64(), -4);
  EXPECT_EQ(reader.f64(), -0.5);
  EXPECT_EQ(reader.text(reader.u8()), "hips");
  EXPECT_TRUE(reader.is_exhausted());
}

TEST(Bytes, AreLittleEndianOnTheWire) {
  std::array<std::uint8_t, 4> buffer;
  ByteWriter(buffer).u32(0x04030201);
  EXPECT_EQ(buffer, (std::array<std::uint8_t, 4>{1, 2, 3, 4}));
}

TEST(ByteWriter, RefusesWhatDoesNotFitAndLeavesTheRestAlone) {
  std::array<std::uint8_t, 6> buffer;
  buffer.fill(0x77);
  ByteWriter writer{std::span<std::uint8_t>(buffer).first(5)};
  writer.u32(1);
  writer.u16(2);
  EXPECT_FALSE(writer.ok());
  EXPECT_EQ(writer.size(), 4u);
  EXPECT_EQ(buffer[4], 0x77);
  writer.u8(3);  // would fit, but what comes after a refused write has no place
  EXPECT_FALSE(writer.ok());
  EXPECT_EQ(writer.size(), 4u);
}

TEST(ByteWriter, StaysWithinEveryShorterBuffer) {
  for (std::size_t size = 0; size < kEverything_bytes; ++size) {
    std::vector<std::uint8_t> exact(size);
    ByteWriter writer(exact);
    write_everything(writer);
    EXPECT_FALSE(writer.ok()) << size;
    EXPECT_LE(writer.size(), size);
  }
}

TEST(ByteReader, GivesZerosAndSaysSoPastTheEnd) {
  const std::array<std::uint8_t, 3> bytes{1, 2, 3};
  ByteReader reader(bytes);
  EXPECT_EQ(reader.u16(), 0x0201);
  EXPECT_EQ(reader.u16(), 0);
  EXPECT_FALSE(reader.ok());
  EXPECT_EQ(reader.u8(), 0);  // stays wrong, though a byte is left
  EXPECT_FALSE(reader.is_exhausted());
}

TEST(ByteReader, RefusesLengthsUpToTheLargest) {
  const std::array<std::uint8_t, 3> bytes{1, 2, 3};
  for (const std::size_t size : {std::size_t{4}, std::numeric_limits<std::size_t>::max()}) {
    ByteReader reader(bytes);
    reader.u8();
    EXPECT_TRUE(reader.bytes(size).empty());
    EXPECT_FALSE(reader.ok());
  }
}

TEST(ByteReader, IsNotExhaustedWhileBytesAreLeft) {
  const std::array<std::uint8_t, 2> bytes{1, 2};
  ByteReader reader(bytes);
  reader.u8();
  EXPECT_TRUE(reader.ok());
  EXPECT_FALSE(reader.is_exhausted());
  EXPECT_EQ(reader.remaining(), 1u);
}

TEST(FixedList, RefusesWhatIsTooMuch) {
  FixedList<int, 3> list;
  for (int i = 0; i < 3; ++i) EXPECT_TRUE(list.try_push(i));
  EXPECT_TRUE(list.is_full());
  EXPECT_FALSE(list.try_push(3));
  EXPECT_EQ(list.size(), 3u);
  EXPECT_FALSE(list.contains(3));
}

TEST(FixedList, ClosesTheGapOfWhatIsErased) {
  FixedList<int, 4> list;
  for (int i = 0; i < 4; ++i) ASSERT_TRUE(list.try_push(i));
  list.erase_at(1);
  EXPECT_EQ(std::vector<int>(list.begin(), list.end()), (std::vector<int>{0, 2, 3}));
  list.erase_at(2);
  EXPECT_EQ(std::vector<int>(list.begin(), list.end()), (std::vector<int>{0, 2}));
}

TEST(FixedListDeathTest, DiesOnAnIndexBehindItsEnd) {
  FixedList<int, 4> list;
  ASSERT_TRUE(list.try_push(1));
  EXPECT_DEATH(list[1] = 2, "i < size_");
}

TEST(ByteReader, ReadsATextUpToItsZero) {
  const std::uint8_t bytes[] = {'a', 'b', 0, 0, 'c', 'd'};
  ByteReader reader(bytes);
  EXPECT_EQ(reader.text_to_zero(10), "ab");
  EXPECT_EQ(reader.text_to_zero(10), "");
  EXPECT_TRUE(reader.ok());
  EXPECT_EQ(reader.text_to_zero(10), "");  // no zero before the end
  EXPECT_FALSE(reader.ok());
  ByteReader again(bytes);
  EXPECT_EQ(again.text_to_zero(1), "");  // too long
  EXPECT_FALSE(again.ok());
  ByteReader just(bytes);
  EXPECT_EQ(just.text_to_zero(2), "ab");
}

TEST(ByteReader, ReadsASingle) {
  const std::uint8_t bytes[] = {0, 0, 0x20, 0xc0};
  ByteReader reader(bytes);
  EXPECT_EQ(reader.f32(), -2.5f);
  EXPECT_EQ(reader.f32(), 0.0f);
  EXPECT_FALSE(reader.ok());
}

}  // namespace
}  // namespace dance
