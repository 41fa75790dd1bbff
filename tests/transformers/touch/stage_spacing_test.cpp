#include "transformers/touch/stage_spacing.h"

#include <gtest/gtest.h>

#include "tests/allocation_guard.h"
#include "tests/transformers/touch/two_dancers.h"

namespace dance {
namespace {

struct SpacedDancer {
  GuestId guest;
  Eigen::Vector3f at_m;
  DancerOf of = DancerOf::kAnother;
  Eigen::Vector3f shown_m = Eigen::Vector3f::Zero();
};

class StageSpacingTest : public ::testing::Test {
 protected:
  void add(const char* name, float x_m, float z_m, DancerOf of = DancerOf::kAnother) {
    dancers_.push_back({*GuestId::parse(name), {x_m, 0.95f, z_m}, of});
  }
  // At 60 pictures a second; returns the fastest motion in m/s.
  float run(double seconds) {
    float fastest = 0.0f;
    for (int i = 0; i < static_cast<int>(60 * seconds); ++i) {
      now_ += Duration::us(16'667);
      for (SpacedDancer& each : dancers_) {
        Pose pose;
        pose.p_WH_m = each.at_m;
        spacing_.apply(each.guest, pose, now_, each.of, holds_);
        if (!each.shown_m.isZero())
          fastest = std::max(fastest, 60.0f * (pose.p_WH_m - each.shown_m).norm());
        each.shown_m = pose.p_WH_m;
      }
    }
    return fastest;
  }
  float apart_m(std::size_t a, std::size_t b) const {
    return (dancers_[a].shown_m - dancers_[b].shown_m).norm();
  }

  StageSpacing spacing_;
  StageHolds holds_;
  std::vector<SpacedDancer> dancers_;
  MonoTime now_ = MonoTime::from_us(1'000'000'000);
};

TEST_F(StageSpacingTest, MovesTwoWhoOverlapApartSmoothlyAfterSomeSeconds) {
  add("alice", 0.0f, 0.0f, DancerOf::kThisHouse);
  add("bob", 0.05f, 0.0f);
  run(1.0);
  EXPECT_LT(apart_m(0, 1), 0.1f) << "a step through each other is no reason";
  EXPECT_LT(run(5.0), 1.0f);
  EXPECT_NEAR(apart_m(0, 1), StageSpacing::kApart_m + 0.05f, 0.02f);
  EXPECT_EQ(dancers_[0].shown_m, dancers_[0].at_m) << "the earlier name stays";
}

TEST_F(StageSpacingTest, FindsTheSameSpotsInAnyOrderOfPoses) {
  add("dora", 0.0f, 0.0f);
  add("alice", 0.02f, 0.0f);
  add("carol", 0.0f, 0.03f);
  add("bob", 0.0f, -0.02f);
  run(20.0);
  const auto shown = dancers_;
  for (std::size_t a = 0; a < 4; ++a)
    for (std::size_t b = 0; b < a; ++b) EXPECT_GT(apart_m(a, b), 0.6f) << a << " " << b;
  dancers_.clear();
  spacing_ = {};
  add("alice", 0.02f, 0.0f, DancerOf::kThisHouse);
  add("bob", 0.0f, -0.02f);
  run(6.0);
  add("carol", 0.0f, 0.03f);
  add("dora", 0.0f, 0.0f);
  run(20.0);
  EXPECT_NEAR((dancers_[1].shown_m - shown[3].shown_m).norm(), 0.0f, 0.01f);
  EXPECT_NEAR((dancers_[2].shown_m - shown[2].shown_m).norm(), 0.0f, 0.01f);
  EXPECT_NEAR((dancers_[3].shown_m - shown[0].shown_m).norm(), 0.0f, 0.01f);
}

TEST_F(StageSpacingTest, DoesNotMovePartnersAtAnArmsLengthNorDancersOfThisHouse) {
  add("alice", 0.0f, 0.0f);
  add("bob", 0.35f, 0.0f);
  run(10.0);
  EXPECT_EQ(dancers_[1].shown_m, dancers_[1].at_m);
  dancers_.clear();
  add("carol", 3.0f, 0.0f, DancerOf::kThisHouse);
  add("dora", 3.1f, 0.0f, DancerOf::kThisHouse);
  run(10.0);
  EXPECT_EQ(dancers_[1].shown_m, dancers_[1].at_m);
}

TEST_F(StageSpacingTest, MovesADancerWhoWalksAwayBackToTheRealSpot) {
  add("alice", 0.0f, 0.0f);
  add("bob", 0.0f, 0.0f);
  run(8.0);
  ASSERT_GT(apart_m(0, 1), 0.7f);
  dancers_[1].at_m.z() = 1.0f;
  run(8.0);
  EXPECT_GT((dancers_[1].shown_m - dancers_[1].at_m).norm(), 0.7f) << "not far enough";
  dancers_[1].at_m.z() = 2.0f;
  run(10.0);
  EXPECT_LT((dancers_[1].shown_m - dancers_[1].at_m).norm(), 0.01f);
}

TEST_F(StageSpacingTest, DoesNotMoveDancersWhoHoldHands) {
  // In the closest embrace.
  const Pose lead = with_palm_at(standing(-0.12f, 0.0f), 0, meeting_place());
  const Pose follow = with_palm_at(standing(0.12f, 3.14159265f), 1, meeting_place());
  MonoTime now = now_;
  for (int i = 0; i < 600; ++i) {
    now += Duration::us(16'667);
    for (const bool is_second : {false, true}) {
      Pose pose = is_second ? follow : lead;
      const GuestId guest = *GuestId::parse(is_second ? "bob" : "alice");
      const Eigen::Vector3f before = pose.p_WH_m;
      spacing_.apply(guest, pose, now, DancerOf::kAnother, holds_);
      EXPECT_EQ(pose.p_WH_m, before);
      holds_.show(guest, pose, now, false, DancerOf::kAnother);
    }
  }
}

TEST_F(StageSpacingTest, AllocatesNothing) {
  add("alice", 0.0f, 0.0f);
  add("bob", 0.0f, 0.0f);
  run(1.0);
  const AllocationGuard guard;
  run(3.0);
  EXPECT_EQ(guard.allocations(), 0u);
}

}  // namespace
}  // namespace dance
