// A writer and readers at the same memory at the same time.
#include <gtest/gtest.h>

#include <atomic>
#include <thread>
#include <vector>

#include "formats/engine/segment_reader.h"
#include "formats/engine/segment_writer.h"
#include "tests/formats/engine/stored_poses.h"

namespace dance::engine {
namespace {

constexpr MonoTime kStart = MonoTime::from_ns(kSomeTime_ns);
constexpr std::uint32_t kWrites = 60'000;

TEST(SegmentThreads, NoReaderSeesAPoseThatIsMadeOfTwo) {
  const auto segment = fresh_segment();
  SegmentWriter writer(*segment, kStart);
  const std::size_t slot = *writer.reserve(*GuestId::parse("alice"));
  writer.write(slot, numbered(0));
  writer.show(slot);
  std::atomic<bool> is_over{false};
  std::atomic<std::uint64_t> torn{0}, backwards{0}, fine{0};
  const auto read = [&](bool reads_all) {
    ReadCounters counters;
    SegmentReader reader(*segment, counters);
    std::uint64_t last = 0;
    do {
      StoredPose pose;
      std::uint64_t number = 0;
      const std::uint32_t generation = reader.generation(slot);
      if (reader.newest(slot, generation, pose, number) == Outcome::kFine) {
        ++fine;
        if (!is_whole(pose)) ++torn;
        if (number < last) ++backwards;
        last = number;
      }
      if (!reads_all) continue;
      const SegmentReader::Numbers numbers = reader.poses_after(slot, 0);
      for (std::uint64_t i = 0; i < numbers.count; ++i)
        if (reader.pose(slot, generation, numbers.first + i, pose) == Outcome::kFine &&
            !is_whole(pose))
          ++torn;
    } while (!is_over);
    EXPECT_EQ(counters.damaged, 0u);
  };
  std::vector<std::thread> readers;
  for (const bool reads_all : {false, true}) readers.emplace_back(read, reads_all);
  for (std::uint32_t n = 1; n <= kWrites || fine < 1000; ++n) writer.write(slot, numbered(n));
  is_over = true;
  for (std::thread& reader : readers) reader.join();
  EXPECT_EQ(torn, 0u);
  EXPECT_EQ(backwards, 0u);
  EXPECT_GE(fine, 1000u);
}

TEST(SegmentThreads, NobodyIsSeenInAnothersPlace) {
  const auto segment = fresh_segment();
  SegmentWriter writer(*segment, kStart);
  const GuestId guests[2] = {*GuestId::parse("alice"), *GuestId::parse("bob")};
  std::atomic<bool> is_over{false};
  std::atomic<std::uint64_t> mistaken{0}, fine{0};
  // Alice's poses have even numbers, bob's odd ones.
  std::thread reading([&] {
    ReadCounters counters;
    SegmentReader reader(*segment, counters);
    while (!is_over)
      for (std::size_t slot = 0; slot < kGuestSlots; ++slot) {
        GuestEntry entry;
        StoredPose pose;
        std::uint64_t number = 0;
        if (reader.guest(slot, entry) != Outcome::kFine) continue;
        if (reader.newest(slot, entry.generation, pose, number) != Outcome::kFine) continue;
        ++fine;
        if (guests[pose.sequence % 2] != entry.id || !is_whole(pose)) ++mistaken;
      }
    EXPECT_EQ(counters.damaged, 0u);
  });
  for (std::uint32_t n = 0; n < kWrites / 4 || fine < 1000; ++n) {
    const std::size_t slot = *writer.reserve(guests[n % 2]);
    for (std::uint32_t i = 0; i < 6; i += 2) writer.write(slot, numbered(n + i));
    writer.show(slot);
    writer.write(slot, numbered(n + 6));
    writer.release(slot);
  }
  is_over = true;
  reading.join();
  EXPECT_EQ(mistaken, 0u);
}

}  // namespace
}  // namespace dance::engine
