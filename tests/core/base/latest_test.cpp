#include "core/base/latest.h"

#include <gtest/gtest.h>

#include <array>
#include <thread>

#include "tests/allocation_guard.h"

namespace dance {
namespace {

TEST(Latest, HasNothingBeforeTheFirstValue) {
  Latest<int> slot;
  EXPECT_EQ(slot.take(), nullptr);
}

TEST(Latest, GivesEachValueOnce) {
  Latest<int> slot;
  slot.put(5);
  const int* value = slot.take();
  ASSERT_NE(value, nullptr);
  EXPECT_EQ(*value, 5);
  EXPECT_EQ(slot.take(), nullptr);
  EXPECT_EQ(slot.overwritten(), 0u);
}

TEST(Latest, GivesTheNewestAndCountsTheOthers) {
  Latest<int> slot;
  for (int i = 1; i <= 10; ++i) slot.put(i);
  const int* value = slot.take();
  ASSERT_NE(value, nullptr);
  EXPECT_EQ(*value, 10);
  EXPECT_EQ(slot.overwritten(), 9u);
}

TEST(Latest, LeavesTheTakenValueAloneWhileTheWriterGoesOn) {
  Latest<int> slot;
  slot.put(1);
  const int* value = slot.take();
  ASSERT_NE(value, nullptr);
  for (int i = 2; i < 20; ++i) {
    slot.put(i);
    EXPECT_EQ(*value, 1);
  }
}

TEST(Latest, NeverTearsNorGoesBackBetweenTwoThreads) {
  // Every word of a value is the same number: a torn value would show two.
  using Wide = std::array<std::uint64_t, 64>;
  constexpr std::uint64_t kLast = 200'000;
  Latest<Wide> slot;
  std::thread writer([&] {
    Wide value;
    for (std::uint64_t i = 1; i <= kLast; ++i) {
      value.fill(i);
      slot.put(value);
    }
  });
  std::uint64_t seen = 0, torn = 0, backwards = 0, newest = 0;
  while (newest != kLast) {
    const Wide* value = slot.take();
    if (value == nullptr) {
      std::this_thread::yield();
      continue;
    }
    ++seen;
    for (const std::uint64_t word : *value)
      if (word != value->front()) ++torn;
    if (value->front() <= newest) ++backwards;
    newest = value->front();
  }
  writer.join();
  EXPECT_EQ(torn, 0u);
  EXPECT_EQ(backwards, 0u);
  EXPECT_EQ(seen + slot.overwritten(), kLast);
}

TEST(Latest, AllocatesNothing) {
  Latest<std::array<int, 100>> slot;
  const std::array<int, 100> value{};
  const AllocationGuard guard;
  for (int i = 0; i < 100; ++i) {
    slot.put(value);
    slot.take();
  }
  EXPECT_EQ(guard.allocations(), 0u);
}

}  // namespace
}  // namespace dance
