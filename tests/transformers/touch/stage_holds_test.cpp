#include "transformers/touch/stage_holds.h"

#include <gtest/gtest.h>

#include "core/base/random.h"
#include "tests/allocation_guard.h"
#include "tests/transformers/touch/two_dancers.h"

namespace dance {
namespace {

using Eigen::Vector3f;

const GuestId kLead = guest_named("lead"), kFollow = guest_named("follow");

// Shows both, the follow's right palm `apart` from the lead's left, at 60 Hz for so long.
struct Couple {
  StageHolds holds;
  std::int64_t ms = 0;
  std::array<Pose, 2> shown;
  int changes = 0;
  bool was_held = false;

  void dance(const Vector3f& apart, std::int64_t length_ms, bool lead_reaches = false,
             bool follow_reaches = false) {
    for (const std::int64_t end = ms + length_ms; ms < end; ms += 16) {
      shown = {with_palm_at(lead_pose(), 0, meeting_place()),
               with_palm_at(follow_pose(), 1, meeting_place() + apart)};
      holds.show(kLead, shown[0], touch_time(ms), lead_reaches, DancerOf::kThisHouse);
      holds.show(kFollow, shown[1], touch_time(ms), follow_reaches, DancerOf::kThisHouse);
      const bool is_held = holds.are_held(kLead, 0, kFollow, 1);
      changes += is_held != was_held;
      was_held = is_held;
    }
  }
  float gap() const { return (palm_in(shown[0], 0) - palm_in(shown[1], 1)).norm(); }
};

TEST(StageHolds, BeginWhereHandsMeetAndEndWhereTheyPartForGood) {
  Couple couple;
  couple.dance({0.0f, 0.3f, 0.0f}, 200);
  EXPECT_FALSE(couple.was_held);
  couple.dance({0.0f, 0.02f, 0.0f}, 100);
  EXPECT_TRUE(couple.was_held);
  EXPECT_TRUE(couple.holds.are_held(kFollow, 1, kLead, 0));
  EXPECT_FALSE(couple.holds.are_held(kLead, 1, kFollow, 1));
  couple.dance({0.0f, 0.15f, 0.0f}, 2000);  // further than they began at, near enough
  EXPECT_TRUE(couple.was_held);
  couple.dance({0.0f, 0.25f, 0.0f}, 100);  // for a moment
  EXPECT_TRUE(couple.was_held);
  couple.dance({0.0f, 0.25f, 0.0f}, 300);
  EXPECT_FALSE(couple.was_held);
  EXPECT_EQ(couple.changes, 2);
}

TEST(StageHolds, DoNotFlickerWithJitter) {
  Couple couple;
  Random random(9);
  int within = 0;
  for (int i = 0; i < 400; ++i) {
    const auto noise = [&] { return static_cast<float>(0.05 * random.normal()); };
    const Vector3f apart(noise(), noise(), noise());
    within += apart.norm() <= 0.08f;
    couple.dance(apart, 16);
  }
  EXPECT_LT(within, 300);  // a plain threshold would flicker
  EXPECT_EQ(couple.changes, 1);
}

TEST(StageHolds, ArmsOfBothReachHalfOfTheWayEach) {
  Couple couple;
  couple.dance({0.0f, 0.02f, 0.0f}, 100, true, true);
  couple.dance({0.06f, 0.08f, 0.0f}, 600, true, true);
  EXPECT_LT(couple.gap(), 0.004f);
  const Vector3f middle = meeting_place() + 0.5f * Vector3f(0.06f, 0.08f, 0.0f);
  EXPECT_LT((palm_in(couple.shown[0], 0) - middle).norm(), 0.004f);
  for (const Pose& pose : couple.shown) EXPECT_TRUE(is_valid(pose));
}

TEST(StageHolds, OneAloneReachesAllOfTheWay) {
  Couple couple;
  couple.dance({0.0f, 0.02f, 0.0f}, 100, false, true);
  couple.dance({0.06f, 0.08f, 0.0f}, 600, false, true);
  EXPECT_LT(couple.gap(), 0.004f);
  EXPECT_LT((palm_in(couple.shown[0], 0) - meeting_place()).norm(), 1e-4f);
}

TEST(StageHolds, ComeAndGoWithoutAJump) {
  Couple couple;
  couple.dance({0.0f, 0.11f, 0.0f}, 200, true, true);
  Vector3f before = palm_in(couple.shown[1], 1);
  float most = 0.0f;
  const auto dance = [&](const Vector3f& apart, int pictures) {
    for (int i = 0; i < pictures; ++i) {
      couple.dance(apart, 16, true, true);
      most = std::max(most, (palm_in(couple.shown[1], 1) - before).norm());
      before = palm_in(couple.shown[1], 1);
    }
  };
  for (int i = 0; i < 10; ++i) dance({0.0f, 0.11f - 0.005f * static_cast<float>(i), 0.0f}, 1);
  dance({0.0f, 0.06f, 0.0f}, 30);
  for (int i = 0; i < 100; ++i) dance({0.0f, 0.06f + 0.004f * static_cast<float>(i), 0.0f}, 1);
  EXPECT_FALSE(couple.was_held);
  EXPECT_LT(most, 0.02f);  // 1.2 m/s
}

TEST(StageHolds, WithoutTheWordAPoseStaysAsItIs) {
  Couple couple;
  couple.dance({0.0f, 0.05f, 0.0f}, 500);
  const Pose plain = with_palm_at(lead_pose(), 0, meeting_place());
  for (std::size_t b = 0; b < kBoneCount; ++b)
    EXPECT_EQ(couple.shown[0].R_PB[b].coeffs(), plain.R_PB[b].coeffs());
}

TEST(StageHolds, WhoLeavesHoldsNobody) {
  Couple couple;
  couple.dance({0.0f, 0.02f, 0.0f}, 200);
  Pose pose = lead_pose();
  for (int i = 0; i < 60; ++i, couple.ms += 16)
    couple.holds.show(kLead, pose, touch_time(couple.ms), false, DancerOf::kThisHouse);
  EXPECT_FALSE(couple.holds.are_held(kLead, 0, kFollow, 1));
}

TEST(StageHolds, ForgetWhoIsGoneAndCountWhoFindsNoPlace) {
  StageHolds holds;
  Pose pose = lead_pose();
  for (int i = 0; i < 20; ++i)
    holds.show(guest_named(("guest-" + std::to_string(i)).c_str()), pose, touch_time(i), true,
               DancerOf::kThisHouse);
  EXPECT_EQ(holds.refused(), 4u);
  holds.show(guest_named("late"), pose, touch_time(2000), true, DancerOf::kThisHouse);
  EXPECT_EQ(holds.refused(), 4u);
}

TEST(StageHolds, InACrowdTheHousesOwnDancerAndWhoIsNearHaveAPlace) {
  StageHolds holds;
  std::array<GuestId, 40> crowd;
  for (std::size_t i = 0; i < crowd.size(); ++i)
    crowd[i] = guest_named(("guest-" + std::to_string(i)).c_str());
  const AllocationGuard guard;
  for (int picture = 0; picture < 10; ++picture) {
    const MonoTime now = touch_time(16 * picture);
    for (std::size_t i = 0; i < crowd.size(); ++i) {
      Pose pose = standing(5.0f + 0.5f * static_cast<float>(i), 0.0f);
      holds.show(crowd[i], pose, now, true, DancerOf::kAnother);
    }
    // The partner comes before the own dancer does, and still has a place with the next picture.
    Pose follow = with_palm_at(follow_pose(), 1, meeting_place());
    holds.show(kFollow, follow, now, true, DancerOf::kAnother);
    Pose lead = with_palm_at(lead_pose(), 0, meeting_place());
    holds.show(kLead, lead, now, true, DancerOf::kThisHouse);
  }
  EXPECT_EQ(guard.allocations(), 0u);
  EXPECT_TRUE(holds.are_held(kLead, 0, kFollow, 1));
  EXPECT_TRUE(holds.is_of_this_house(kLead));
  EXPECT_FALSE(holds.is_of_this_house(kFollow));
  EXPECT_GT(holds.refused(), 0u);
}

TEST(StageHolds, AllocateNothingAndStandATimeThatJumps) {
  Couple couple;
  couple.dance({0.0f, 0.02f, 0.0f}, 200, true, true);
  Pose a = couple.shown[0], b = couple.shown[1];
  const AllocationGuard guard;
  for (const std::int64_t ms : {0, 1'000'000, 5, 5, -500, 90'000}) {
    couple.holds.show(kLead, a, touch_time(ms), true, DancerOf::kThisHouse);
    couple.holds.show(kFollow, b, touch_time(ms), true, DancerOf::kThisHouse);
  }
  EXPECT_EQ(guard.allocations(), 0u);
  EXPECT_TRUE(is_valid(a));
  EXPECT_TRUE(is_valid(b));
}

}  // namespace
}  // namespace dance
