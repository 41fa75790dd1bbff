#include "core/base/random.h"

#include <gtest/gtest.h>

#include <array>

namespace dance {
namespace {

TEST(Random, GivesThePublishedNumbersOfSplitMix64) {
  Random random(1234567);
  EXPECT_EQ(random.next_u64(), 6457827717110365317ULL);
  EXPECT_EQ(random.next_u64(), 3203168211198807973ULL);
  EXPECT_EQ(random.next_u64(), 9817491932198370423ULL);
}

TEST(Random, GivesTheSameForTheSameSeedOnly) {
  Random a(7), b(7), c(8);
  const std::uint64_t first = a.next_u64();
  EXPECT_EQ(first, b.next_u64());
  EXPECT_NE(first, c.next_u64());
}

TEST(Random, IsUniformWithinItsBounds) {
  Random random(42);
  std::array<int, 10> counts{};
  for (int i = 0; i < 100'000; ++i) {
    const double u = random.uniform();
    ASSERT_GE(u, 0.0);
    ASSERT_LT(u, 1.0);
    ++counts[static_cast<std::size_t>(u * 10.0)];
    ASSERT_LT(random.below(7), 7u);
  }
  for (const int count : counts) EXPECT_NEAR(count, 10'000, 500);  // five standard deviations
}

TEST(Random, ReachesEveryNumberBelowABound) {
  Random random(3);
  std::array<bool, 7> is_reached{};
  for (int i = 0; i < 1000; ++i) is_reached[random.below(7)] = true;
  for (const bool reached : is_reached) EXPECT_TRUE(reached);
  EXPECT_EQ(random.below(1), 0u);
}

TEST(Random, IsNormalWithMeanZeroAndDeviationOne) {
  Random random(5);
  double sum = 0.0, sum_of_squares = 0.0;
  constexpr int kCount = 100'000;
  for (int i = 0; i < kCount; ++i) {
    const double x = random.normal();
    sum += x;
    sum_of_squares += x * x;
  }
  EXPECT_NEAR(sum / kCount, 0.0, 0.016);
  EXPECT_NEAR(sum_of_squares / kCount, 1.0, 0.025);
}

}  // namespace
}  // namespace dance
