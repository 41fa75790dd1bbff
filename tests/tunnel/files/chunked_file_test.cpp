// A file in chunks, in any order.
#include "tunnel/files/chunked_file.h"

#include <gtest/gtest.h>

#include <numeric>

#include "tests/tunnel/files/test_file.h"
#include "tunnel/files/chunk_requests.h"

namespace dance {
namespace {

TEST(ChunkedFile, IsWholeWhenAllHaveComeInAnyOrder) {
  for (const std::size_t size : {1u, 1023u, 1024u, 1025u, 65'536u, 65'537u, 300'001u}) {
    const TestFile file = test_file(size);
    ChunkedFile chunked(file.size());
    std::vector<std::size_t> order(chunked.chunks());
    std::iota(order.begin(), order.end(), 0u);
    Random random(7);
    for (std::size_t i = order.size(); i > 1; --i) std::swap(order[i - 1], order[random.below(i)]);
    for (const std::size_t index : order) {
      EXPECT_FALSE(chunked.is_whole());
      EXPECT_FALSE(chunked.has(index));
      EXPECT_TRUE(chunked.put(index, file.chunk(index)));
      EXPECT_FALSE(chunked.put(index, file.chunk(index)));
      EXPECT_TRUE(std::ranges::equal(chunked.chunk(index), file.chunk(index)));
    }
    EXPECT_TRUE(chunked.is_whole());
    std::vector<std::uint8_t> bytes;
    for (std::size_t b = 0; b < chunked.blocks(); ++b) {
      EXPECT_TRUE(chunked.has_block(b));
      bytes.insert(bytes.end(), chunked.block(b).begin(), chunked.block(b).end());
    }
    EXPECT_EQ(bytes, file.bytes);
  }
}

TEST(ChunkedFile, FindsWhatIsMissing) {
  const TestFile file = test_file(200 * wire::kFileChunk);
  ChunkedFile chunked(file.size());
  for (std::size_t i = 0; i < 200; ++i)
    if (i != 3 && i != 64 && i != 199) chunked.put(i, file.chunk(i));
  EXPECT_EQ(chunked.missing(), 3u);
  EXPECT_EQ(chunked.next_missing(0), 3u);
  EXPECT_EQ(chunked.next_missing(4), 64u);
  EXPECT_EQ(chunked.next_missing(65), 199u);
  chunked.put(199, file.chunk(199));
  EXPECT_EQ(chunked.next_missing(65), 200u);
  EXPECT_FALSE(chunked.has_block(0));
  EXPECT_FALSE(chunked.has_block(1));
  EXPECT_TRUE(chunked.has_block(2));
  EXPECT_TRUE(chunked.has_block(3));
}

TEST(ChunkRequests, AreAWindowThatForgetsWhatIsLate) {
  ChunkRequests asked;
  MonoTime now = MonoTime::from_us(1'000'000);
  for (std::size_t i = 0; i < ChunkRequests::kMost; ++i, now += Duration::ms(1))
    EXPECT_TRUE(asked.add(i, now));
  EXPECT_TRUE(asked.is_full());
  EXPECT_FALSE(asked.add(999, now));
  EXPECT_EQ(asked.take(5), MonoTime::from_us(1'005'000));
  EXPECT_FALSE(asked.take(5).is_set());
  EXPECT_EQ(asked.oldest(), MonoTime::from_us(1'000'000));
  EXPECT_EQ(asked.expire(MonoTime::from_us(1'010'000)), 9u);
  EXPECT_FALSE(asked.has(0));
  EXPECT_TRUE(asked.has(10));
  EXPECT_EQ(asked.free(), 10u);
}

}  // namespace
}  // namespace dance
