// What a house sends of its guests' files: what is asked for, at the pace, and nothing else.
#include "tunnel/files/file_sender.h"

#include <gtest/gtest.h>

#include "tests/tunnel/files/test_file.h"

namespace dance {
namespace {

const TestFile kFile = test_file(100'000);
const wire::FileName kName{{3, 1}, kFile.hash};

TEST(FileSender, SendsWhatIsAskedForOnceAndInOrder) {
  FileSender sender(1e9);
  sender.offer(guest("alice"), kFile.hash, kFile.shared());
  MonoTime now = MonoTime::from_us(1'000'000);
  EXPECT_TRUE(sender.want(guest("alice"), {kName, 4, 0b1011}, now));
  EXPECT_TRUE(sender.want(guest("alice"), {kName, 4, 0b0001}, now)) << "waits already";
  for (const std::uint16_t index : std::array<std::uint16_t, 3>{4, 5, 7}) {
    now += Duration::ms(1);
    const auto chunk = sender.next(now);
    ASSERT_TRUE(chunk);
    EXPECT_EQ(chunk->index, index);
    EXPECT_EQ(chunk->size_bytes, kFile.size());
    EXPECT_TRUE(std::ranges::equal(chunk->data, kFile.chunk(index)));
  }
  now += Duration::ms(1);
  EXPECT_FALSE(sender.next(now));
  EXPECT_FALSE(sender.next_deadline().is_set());
}

TEST(FileSender, KeepsItsPaceByItsOwnDeadlines) {
  FileSender sender(100'000.0);
  sender.offer(guest("alice"), kFile.hash, kFile.shared());
  MonoTime now = MonoTime::from_us(1'000'000);
  const MonoTime begin = now;
  sender.want(guest("alice"), {kName, 0, 0xffffffff}, now);
  std::size_t sent = 0, turns = 0;
  while (sender.next_deadline().is_set()) {
    now = std::max(now, sender.next_deadline());
    ++turns;
    if (sender.next(now)) ++sent;
    EXPECT_FALSE(sender.next(now)) << "two at once";
  }
  EXPECT_EQ(sent, 32u);
  EXPECT_LE(turns, 34u);
  const double rate = 31.0 * wire::kFileChunkCost / (now - begin).as_seconds();
  EXPECT_NEAR(rate, 100'000.0, 1'000.0);
}

TEST(FileSender, OffersOnlyWhatTheGuestHasChosen) {
  FileSender sender(1e9);
  MonoTime now = MonoTime::from_us(1'000'000);
  EXPECT_FALSE(sender.want(guest("alice"), {kName, 0, 1}, now));
  sender.offer(guest("alice"), kFile.hash, kFile.shared());
  EXPECT_FALSE(sender.want(guest("bob"), {kName, 0, 1}, now)) << "another guest's";
  EXPECT_TRUE(sender.want(guest("alice"), {kName, 0, 1}, now));
  sender.offer(guest("alice"), FileHash(), nullptr);
  EXPECT_FALSE(sender.next(now)) << "taken back while it waited";
  EXPECT_FALSE(sender.want(guest("alice"), {kName, 0, 1}, now));
  EXPECT_EQ(sender.counters().not_offered, 3u);
}

TEST(FileSender, HasAQueueThatIsBounded) {
  FileSender sender(1e9);
  const TestFile large = test_file(1'000'000, 7);
  sender.offer(guest("alice"), large.hash, large.shared());
  MonoTime now = MonoTime::from_us(1'000'000);
  for (std::uint16_t first = 0; first < 960; first = static_cast<std::uint16_t>(first + 32))
    sender.want(guest("alice"), {{{3, 1}, large.hash}, first, 0xffffffff}, now);
  std::size_t sent = 0;
  for (; sender.next_deadline().is_set(); ++sent) {
    now += Duration::ms(1);
    sender.next(now);
  }
  EXPECT_LE(sent, 129u);
  EXPECT_GT(sender.counters().queue_full, 0u);
}

TEST(FileSender, SlowsDownWhereMuchIsAskedForAgain) {
  FileSender sender(1e6);
  sender.offer(guest("alice"), kFile.hash, kFile.shared());
  MonoTime now = MonoTime::from_us(1'000'000);
  for (int round = 0; round < 20; ++round) {
    sender.want(guest("alice"), {kName, 0, 0xff}, now);
    for (int i = 0; i < 200; ++i, now += Duration::ms(1)) sender.next(now);
  }
  EXPECT_GT(sender.counters().chunks_again, 50u);
  EXPECT_LT(sender.pace().share(), 0.5);
}

}  // namespace
}  // namespace dance
