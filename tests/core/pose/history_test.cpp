#include "core/pose/history.h"

#include <gtest/gtest.h>

#include "tests/allocation_guard.h"

namespace dance {
namespace {

// A pose whose time and place tell its number: number n at n·10 ms, hips at x = n.
Pose numbered(int n) {
  Pose pose;
  pose.capture_time = MonoTime::from_us(1'000'000 + n * 10'000);
  pose.p_WH_m.x() = static_cast<float>(n);
  pose.sequence = static_cast<std::uint32_t>(n);
  return pose;
}
MonoTime time_of(double n) { return MonoTime::from_us(1'000'000) + Duration::seconds(n * 0.010); }

TEST(PoseHistory, AnswersNothingWhileEmpty) {
  PoseHistory history(4);
  EXPECT_FALSE(history.at(time_of(0)).has_value());
  history.push(numbered(1));
  history.clear();
  EXPECT_FALSE(history.at(time_of(1)).has_value());
  EXPECT_TRUE(history.push(numbered(0)));  // after a clear an older one may begin again
}

TEST(PoseHistory, GivesBackExactlyWhatWasPushed) {
  PoseHistory history(8);
  for (int n = 0; n < 5; ++n) EXPECT_TRUE(history.push(numbered(n)));
  for (int n = 0; n < 5; ++n) {
    const auto answer = history.at(time_of(n));
    ASSERT_TRUE(answer.has_value());
    EXPECT_EQ(answer->how, PoseHistory::How::kExact);
    EXPECT_EQ(answer->pose.sequence, static_cast<std::uint32_t>(n));
  }
}

TEST(PoseHistory, InterpolatesBetweenNeighbours) {
  PoseHistory history(8);
  for (int n = 0; n < 5; ++n) history.push(numbered(n));
  for (double n = 0.125; n < 4.0; n += 0.25) {
    const auto answer = history.at(time_of(n));
    ASSERT_TRUE(answer.has_value());
    EXPECT_EQ(answer->how, PoseHistory::How::kInterpolated);
    EXPECT_NEAR(static_cast<double>(answer->pose.p_WH_m.x()), n, 1e-4);
    EXPECT_LE(answer->pose.capture_time - time_of(n), Duration::us(1));
    EXPECT_GE(answer->pose.capture_time - time_of(n), Duration::us(-1));
  }
}

TEST(PoseHistory, GoesSmoothlyBetweenPosesCloseTogetherAndStraightAcrossGaps) {
  for (const double step_s : {0.033, 0.2}) {
    PoseHistory history(8);
    for (int n = 0; n < 6; ++n) {
      Pose pose = numbered(n);
      pose.capture_time = MonoTime::from_us(1'000'000) + Duration::seconds(step_s * n);
      pose.p_WH_m.x() = static_cast<float>(n * n);
      history.push(pose);
    }
    const bool is_smooth = step_s < 0.1;
    for (double n = 1.5; n < 4.0; n += 1.0) {
      const auto answer = history.at(MonoTime::from_us(1'000'000) + Duration::seconds(step_s * n));
      EXPECT_NEAR(static_cast<double>(answer->pose.p_WH_m.x()), is_smooth ? n * n : n * n + 0.25,
                  1e-3);
    }
    // At the ends there is one neighbour only, and between two poses none.
    EXPECT_TRUE(history.at(history.oldest().capture_time + Duration::ms(1)));
    EXPECT_TRUE(history.at(history.newest().capture_time - Duration::ms(1)));
  }
  PoseHistory two(4);
  two.push(numbered(0));
  two.push(numbered(1));
  EXPECT_NEAR(static_cast<double>(two.at(time_of(0.25))->pose.p_WH_m.x()), 0.25, 1e-4);
}

TEST(PoseHistory, HoldsItsEnds) {
  PoseHistory history(8);
  for (int n = 0; n < 5; ++n) history.push(numbered(n));
  EXPECT_EQ(history.at(time_of(-3))->how, PoseHistory::How::kHeldFirst);
  EXPECT_EQ(history.at(time_of(-3))->pose.sequence, 0u);
  EXPECT_EQ(history.at(time_of(9))->how, PoseHistory::How::kHeldLast);
  EXPECT_EQ(history.at(time_of(9))->pose.sequence, 4u);
}

TEST(PoseHistory, ForgetsTheOldestInEveryPositionOfItsRing) {
  PoseHistory history(5);
  for (int n = 0; n < 23; ++n) {
    ASSERT_TRUE(history.push(numbered(n)));
    ASSERT_EQ(history.size(), static_cast<std::size_t>(std::min(n + 1, 5)));
    EXPECT_EQ(history.newest().sequence, static_cast<std::uint32_t>(n));
    EXPECT_EQ(history.oldest().sequence, static_cast<std::uint32_t>(std::max(0, n - 4)));
    for (int back = 0; back < static_cast<int>(history.size()); ++back) {
      EXPECT_EQ(history.newest(static_cast<std::size_t>(back)).sequence,
                static_cast<std::uint32_t>(n - back));
      EXPECT_EQ(history.at(time_of(n - back))->how, PoseHistory::How::kExact);
      EXPECT_EQ(history.at(time_of(n - back))->pose.sequence, static_cast<std::uint32_t>(n - back));
    }
  }
  EXPECT_EQ(history.at(time_of(3))->how, PoseHistory::How::kHeldFirst);
}

TEST(PoseHistory, RefusesWhatIsNotNewer) {
  PoseHistory history(4);
  EXPECT_TRUE(history.push(numbered(3)));
  EXPECT_FALSE(history.push(numbered(3)));
  EXPECT_FALSE(history.push(numbered(2)));
  EXPECT_EQ(history.size(), 1u);
  EXPECT_TRUE(history.push(numbered(4)));
}

TEST(PoseHistory, AnswersOneStepAfterAGap) {
  PoseHistory history(4);
  history.push(numbered(0));
  history.push(numbered(100));
  EXPECT_NEAR(history.at(time_of(25))->pose.p_WH_m.x(), 25.0f, 1e-3f);
}

TEST(PoseHistory, AllocatesNothingOnceMade) {
  PoseHistory history(16);
  const AllocationGuard guard;
  for (int n = 0; n < 100; ++n) {
    history.push(numbered(n));
    EXPECT_TRUE(history.at(time_of(n - 0.5)).has_value());
  }
  EXPECT_EQ(guard.allocations(), 0u);
}

TEST(PoseHistoryDeathTest, DiesOnAskingBehindItsEnd) {
  PoseHistory history(4);
  history.push(numbered(0));
  EXPECT_DEATH(history.newest(1), "back < size_");
  EXPECT_DEATH(PoseHistory(1), "capacity >= 2");
}

}  // namespace
}  // namespace dance
