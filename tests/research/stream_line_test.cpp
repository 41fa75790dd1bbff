#include "research/lapse/stream_line.h"

#include <gtest/gtest.h>

#include <cmath>

namespace dance {
namespace {

std::vector<Pose> steady(std::size_t count) {
  std::vector<Pose> poses(count);
  for (std::size_t i = 0; i < count; ++i)
    poses[i].capture_time = MonoTime::from_us(1'000'000 + 16'667 * static_cast<std::int64_t>(i));
  return poses;
}

TEST(StreamLine, WithoutJitterAndLossDeliversEachAfterTheDelay) {
  const std::vector<Pose> poses = steady(100);
  StreamLine line;
  line.delay = Duration::ms(80);
  const auto arrivals = arrivals_over(line, poses);
  ASSERT_EQ(arrivals.size(), 100u);
  for (std::size_t i = 0; i < 100; ++i) {
    EXPECT_EQ(arrivals[i].index, i);
    EXPECT_EQ(arrivals[i].at, poses[i].capture_time + Duration::ms(80));
  }
}

TEST(StreamLine, JitterOfEveryShapeHasTheMeanThatWasAskedFor) {
  const std::vector<Pose> poses = steady(20'000);
  // Standard deviations in units of the mean: 1, 1/sqrt(2), sqrt(pi/2 - 1).
  const std::pair<StreamLine::Jitter, double> shapes[] = {
      {StreamLine::Jitter::kExponential, 1.0},
      {StreamLine::Jitter::kGamma, std::sqrt(0.5)},
      {StreamLine::Jitter::kNormal, std::sqrt(M_PI / 2.0 - 1.0)}};
  for (const auto& [shape, deviation] : shapes) {
    StreamLine line;
    line.jitter = Duration::ms(15);
    line.shape = shape;
    double sum_ms = 0.0, squares = 0.0;
    for (const StreamArrival& arrival : arrivals_over(line, poses)) {
      const double late_ms = (arrival.at - poses[arrival.index].capture_time - line.delay).as_ms();
      ASSERT_GE(late_ms, 0.0);
      sum_ms += late_ms;
      squares += late_ms * late_ms;
    }
    const double mean_ms = sum_ms / 20'000.0;
    EXPECT_NEAR(mean_ms, 15.0, 0.4);
    EXPECT_NEAR(std::sqrt(squares / 20'000.0 - mean_ms * mean_ms), 15.0 * deviation, 0.6);
  }
}

TEST(StreamLine, KeepsTheOrderOfArrivalEvenWhereItIsNotThatOfCapture) {
  const std::vector<Pose> poses = steady(2000);
  StreamLine line;
  line.jitter = Duration::ms(30);
  std::size_t overtaken = 0;
  const auto arrivals = arrivals_over(line, poses);
  for (std::size_t i = 1; i < arrivals.size(); ++i) {
    EXPECT_GE(arrivals[i].at, arrivals[i - 1].at);
    overtaken += arrivals[i].index < arrivals[i - 1].index ? 1 : 0;
  }
  EXPECT_GT(overtaken, 100u);
}

TEST(StreamLine, LosesThePartThatWasAskedForAndTheSameEachTime) {
  const std::vector<Pose> poses = steady(20'000);
  StreamLine line;
  line.loss_percent = 5.0;
  const auto first = arrivals_over(line, poses), second = arrivals_over(line, poses);
  EXPECT_NEAR(static_cast<double>(first.size()), 19'000.0, 100.0);
  ASSERT_EQ(first.size(), second.size());
  for (std::size_t i = 0; i < first.size(); ++i) EXPECT_EQ(first[i].index, second[i].index);
}

TEST(StreamLine, AStallHoldsWhatWouldHaveComeOrLosesIt) {
  const std::vector<Pose> poses = steady(300);
  StreamLine line;
  line.delay = Duration::ms(100);
  const MonoTime begin = MonoTime::from_us(2'000'000), end = begin + Duration::ms(400);
  line.stalls = {{begin, Duration::ms(400), false}};
  std::size_t at_end = 0;
  for (const StreamArrival& arrival : arrivals_over(line, poses)) {
    EXPECT_TRUE(arrival.at < begin || arrival.at >= end);
    at_end += arrival.at == end ? 1 : 0;
  }
  EXPECT_NEAR(static_cast<double>(at_end), 24.0, 1.0);
  line.stalls[0].loses = true;
  EXPECT_NEAR(static_cast<double>(arrivals_over(line, poses).size()), 276.0, 1.0);
}

}  // namespace
}  // namespace dance
