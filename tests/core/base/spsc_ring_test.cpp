#include "core/base/spsc_ring.h"

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <memory>
#include <thread>

namespace dance {
namespace {

TEST(SpscRing, GivesEntriesInOrder) {
  SpscRing<int, 4> ring;
  EXPECT_FALSE(ring.pop().has_value());
  for (int i = 0; i < 4; ++i) ring.push(i);
  for (int i = 0; i < 4; ++i) EXPECT_EQ(ring.pop(), i);
  EXPECT_FALSE(ring.pop().has_value());
  EXPECT_EQ(ring.overwritten(), 0u);
}

TEST(SpscRing, OverwritesTheOldestAndCountsThem) {
  SpscRing<int, 4> ring;
  for (int i = 0; i < 11; ++i) ring.push(i);
  for (int i = 7; i < 11; ++i) EXPECT_EQ(ring.pop(), i);
  EXPECT_FALSE(ring.pop().has_value());
  EXPECT_EQ(ring.overwritten(), 7u);
}

TEST(SpscRing, KeepsTypesOfAnySizeWhole) {
  struct Odd {
    char bytes[13];
  };
  SpscRing<Odd, 2> ring;
  ring.push(Odd{"abcdefghijkl"});
  const auto odd = ring.pop();
  ASSERT_TRUE(odd.has_value());
  EXPECT_STREQ(odd->bytes, "abcdefghijkl");
}

struct Flow {
  std::uint64_t popped = 0, torn = 0, out_of_order = 0;
};

// A writer that never waits against a reader that does, sometimes: what is read is whole and in
// order, and every entry is either read or counted.
Flow run_two_threads(SpscRing<std::array<std::uint64_t, 16>, 64>& ring, std::uint64_t last,
                     bool is_reader_slow) {
  std::atomic<bool> is_written = false;
  std::thread writer([&] {
    std::array<std::uint64_t, 16> value;
    for (std::uint64_t i = 1; i <= last; ++i) {
      value.fill(i);
      ring.push(value);
    }
    is_written = true;
  });
  Flow flow;
  std::uint64_t newest = 0;
  for (;;) {
    const bool was_written = is_written;
    const auto value = ring.pop();
    if (!value.has_value()) {
      if (was_written) break;
      std::this_thread::yield();
      continue;
    }
    ++flow.popped;
    for (const std::uint64_t word : *value)
      if (word != value->front()) ++flow.torn;
    if (value->front() <= newest) ++flow.out_of_order;
    newest = value->front();
    if (is_reader_slow && flow.popped % 64 == 0) std::this_thread::yield();
  }
  writer.join();
  EXPECT_EQ(newest, last);
  return flow;
}

TEST(SpscRing, ReadsOrCountsEveryEntryBetweenTwoThreads) {
  constexpr std::uint64_t kLast = 200'000;
  for (const bool is_reader_slow : {false, true}) {
    const auto ring = std::make_unique<SpscRing<std::array<std::uint64_t, 16>, 64>>();
    const Flow flow = run_two_threads(*ring, kLast, is_reader_slow);
    EXPECT_EQ(flow.torn, 0u);
    EXPECT_EQ(flow.out_of_order, 0u);
    EXPECT_EQ(flow.popped + ring->overwritten(), kLast);
  }
}

}  // namespace
}  // namespace dance
