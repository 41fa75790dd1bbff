#include "testing/line/line_arrivals.h"

#include <gtest/gtest.h>

namespace dance {
namespace {

MonoTime sent_at(std::size_t i) {
  return MonoTime::from_us(1'000'000 + 16'667 * static_cast<std::int64_t>(i));
}

std::vector<LineArrival> arrivals_over(const char* words, std::size_t count,
                                       std::size_t every = 1) {
  LossyModel line({.spec = *LossySpec::parse(words)}, 0);
  return arrivals_over(line, count, sent_at, every);
}

TEST(LineArrivals, OverASteadyLineEachComesAfterTheDelay) {
  const auto arrivals = arrivals_over("delay=80ms", 100);
  ASSERT_EQ(arrivals.size(), 100u);
  for (std::size_t i = 0; i < 100; ++i) {
    EXPECT_EQ(arrivals[i].index, i);
    EXPECT_EQ(arrivals[i].at, sent_at(i) + Duration::ms(80));
  }
}

TEST(LineArrivals, AreInTheOrderOfArrivalWhereThatIsNotTheOneOfSending) {
  const auto arrivals = arrivals_over("tail=30ms", 2000);
  std::size_t overtaken = 0;
  for (std::size_t i = 1; i < arrivals.size(); ++i) {
    EXPECT_GE(arrivals[i].at, arrivals[i - 1].at);
    overtaken += arrivals[i].index < arrivals[i - 1].index ? 1 : 0;
  }
  EXPECT_GT(overtaken, 100u);
}

TEST(LineArrivals, OfASlowSensorAreEachSoManyth) {
  const auto arrivals = arrivals_over("delay=1ms", 10, 4);
  ASSERT_EQ(arrivals.size(), 3u);
  EXPECT_EQ(arrivals[1].index, 4u);
  EXPECT_EQ(arrivals[2].index, 8u);
}

TEST(LineArrivals, AStallHoldsBackWhatWouldHaveComeMeanwhileAndNothingElse) {
  const auto before = arrivals_over("delay=100ms", 300);
  auto arrivals = before;
  const MonoTime begin = MonoTime::from_us(2'000'000), end = begin + Duration::ms(400);
  stall(arrivals, begin, Duration::ms(400));
  ASSERT_EQ(arrivals.size(), before.size());
  std::size_t held = 0;
  for (std::size_t i = 0; i < arrivals.size(); ++i) {
    EXPECT_EQ(arrivals[i].index, before[i].index);
    const bool is_meanwhile = before[i].at >= begin && before[i].at < end;
    EXPECT_EQ(arrivals[i].at, is_meanwhile ? end : before[i].at) << i;
    held += is_meanwhile ? 1 : 0;
  }
  EXPECT_NEAR(static_cast<double>(held), 24.0, 1.0);
}

TEST(LineArrivals, AStallHoldsBackWhatWouldHaveComeInTheOrderOfSending) {
  auto arrivals = arrivals_over("delay=100ms tail=30ms", 300);
  const MonoTime begin = MonoTime::from_us(2'000'000), end = begin + Duration::ms(400);
  stall(arrivals, begin, Duration::ms(400));
  EXPECT_EQ(arrivals.size(), 300u);
  std::size_t at_end = 0, newest = 0;
  for (const LineArrival& arrival : arrivals) {
    EXPECT_TRUE(arrival.at < begin || arrival.at >= end);
    if (arrival.at != end) continue;
    EXPECT_TRUE(at_end == 0 || arrival.index > newest);
    newest = arrival.index;
    ++at_end;
  }
  EXPECT_NEAR(static_cast<double>(at_end), 24.0, 6.0);
}

}  // namespace
}  // namespace dance
