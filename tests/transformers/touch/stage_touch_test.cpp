#include "transformers/touch/stage_touch.h"

#include <gtest/gtest.h>

#include <vector>

#include "tests/allocation_guard.h"
#include "tests/transformers/touch/two_dancers.h"

namespace dance {
namespace {

using Eigen::Vector3f;

const GuestId kAlice = guest_named("alice"), kBob = guest_named("bob");

struct Told {
  GuestId guest;
  Touch touch;
};

struct TouchNotes final : TouchSink {
  void on_touch(const GuestId& guest, const Touch& touch) override {
    EXPECT_TRUE(is_valid(touch));
    ++count;
    if (notes) notes->push_back({guest, touch});
  }
  std::vector<Told>* notes = nullptr;
  std::size_t count = 0;
};

struct TouchingStage {
  StageHolds holds;
  StageTouch touch;
  std::vector<Told> told;
  TouchNotes sink;
  std::int64_t ms = 0;
  TouchingStage() { sink.notes = &told; }
  void show(Pose alice, Pose bob) {
    holds.show(kAlice, alice, touch_time(ms), false, DancerOf::kThisHouse);
    holds.show(kBob, bob, touch_time(ms), false, DancerOf::kThisHouse);
    touch.show(kAlice, alice, touch_time(ms), DancerOf::kThisHouse);
    touch.show(kBob, bob, touch_time(ms), DancerOf::kThisHouse);
    touch.update(touch_time(ms), 7, holds, sink);
    ms += 16;
  }
  std::size_t count(TouchPhase phase) const {
    return static_cast<std::size_t>(std::count_if(
        told.begin(), told.end(), [&](const Told& t) { return t.touch.phase == phase; }));
  }
};

TEST(StageTouch, TellsBothOfAPalmOnAChestWithWhereAndHowFast) {
  TouchingStage stage;
  Vector3f place(0.0f, 1.25f, -0.05f);
  for (int i = 0; i < 30; ++i) {
    stage.show(with_palm_at(lead_pose(), 0, {0.4f, 1.0f, -0.4f}),
               with_palm_at(follow_pose(), 0, place));
    place.z() -= 0.01f;  // 0.6 m/s towards the lead, up to the chest
  }
  const Told* first = nullptr;
  for (const Told& each : stage.told)
    if (each.touch.bone == Bone::kLeftHand || each.touch.other_bone == Bone::kLeftHand) {
      first = &each;
      break;
    }
  ASSERT_NE(first, nullptr);
  EXPECT_EQ(first->guest, kAlice);
  EXPECT_EQ(first->touch.other, kBob);
  EXPECT_EQ(first->touch.other_bone, Bone::kLeftHand);
  EXPECT_EQ(first->touch.phase, TouchPhase::kBegins);
  EXPECT_FALSE(first->touch.is_hold);
  EXPECT_EQ(first->touch.clock_id, 7u);
  EXPECT_NEAR(first->touch.approach_m_s, 0.6f, 0.35f);
  EXPECT_LT(first->touch.motion_m_s.z(), -0.2f);  // towards alice, who faces it
  EXPECT_GT(first->touch.place_m.y(), 0.9f);
  const Told& second = *(first + 1);
  EXPECT_EQ(second.guest, kBob);
  EXPECT_EQ(second.touch.contact, first->touch.contact);
  EXPECT_EQ(second.touch.bone, Bone::kLeftHand);
  // Deeper is more force.
  const Told& last = stage.told.back();
  EXPECT_GT(last.touch.depth_m, 0.01f);
  EXPECT_GT(last.touch.force_n, first->touch.force_n);
}

TEST(StageTouch, AContactHasOneNumberFromBeginToEndAndEndsWithSomeDistance) {
  TouchingStage stage;
  const Vector3f on(0.0f, 1.25f, -0.2f);
  stage.show(lead_pose(), with_palm_at(follow_pose(), 0, on + Vector3f(0, 0, 0.2f)));
  for (int i = 0; i < 10; ++i) stage.show(lead_pose(), with_palm_at(follow_pose(), 0, on));
  const std::size_t begun = stage.count(TouchPhase::kBegins);
  ASSERT_GT(begun, 0u);
  for (int i = 0; i < 10; ++i) stage.show(lead_pose(), standing(1.5f, 3.14159265f));
  EXPECT_EQ(stage.count(TouchPhase::kEnded), begun);
  for (const Told& t : stage.told) EXPECT_GT(t.touch.contact, 0u);
}

TEST(StageTouch, HeldHandsAreAHoldEvenWhereTheyAreApart) {
  TouchingStage stage;
  const auto show = [&](float apart) {
    stage.show(with_palm_at(lead_pose(), 0, meeting_place()),
               with_palm_at(follow_pose(), 1, meeting_place() + Vector3f(0.0f, apart, 0.0f)));
  };
  for (int i = 0; i < 10; ++i) show(0.0f);
  stage.told.clear();
  for (int i = 0; i < 30; ++i) show(0.16f);
  std::size_t holds = 0;
  for (const Told& t : stage.told) {
    if (!t.touch.is_hold) continue;
    ++holds;
    EXPECT_EQ(t.touch.phase, TouchPhase::kLasts);
    EXPECT_NEAR(t.touch.depth_m, 0.16f, 0.01f);
  }
  EXPECT_GE(holds, 20u);  // thirty a second, to each of the two
  EXPECT_LE(holds, 34u);
}

TEST(StageTouch, EndsForWhoLeavesAndForWhoGoesFar) {
  TouchingStage stage;
  for (int i = 0; i < 5; ++i) stage.show(lead_pose(), lead_pose());
  const std::size_t begun = stage.count(TouchPhase::kBegins);
  ASSERT_GT(begun, 0u);
  EXPECT_LE(begun, 2 * kBodyParts * kBodyParts);
  stage.show(lead_pose(), standing(20.0f, 0.0f));
  EXPECT_EQ(stage.count(TouchPhase::kEnded), begun);
  for (int i = 0; i < 5; ++i) stage.show(lead_pose(), lead_pose());
  stage.touch.update(touch_time(stage.ms + 2000), 7, stage.holds, stage.sink);
  EXPECT_EQ(stage.count(TouchPhase::kEnded), stage.count(TouchPhase::kBegins));
}

TEST(StageTouch, IsBoundedAndAllocatesNothing) {
  StageHolds holds;
  StageTouch touch;
  TouchNotes sink;
  std::array<GuestId, 24> guests;
  for (std::size_t i = 0; i < guests.size(); ++i)
    guests[i] = guest_named(("guest-" + std::to_string(i)).c_str());
  const AllocationGuard guard;
  for (int picture = 0; picture < 20; ++picture) {
    for (const GuestId& guest : guests)
      touch.show(guest, lead_pose(), touch_time(16 * picture), DancerOf::kThisHouse);
    touch.update(touch_time(16 * picture), 7, holds, sink);
  }
  EXPECT_EQ(guard.allocations(), 0u);
  EXPECT_GT(touch.refused(), 0u);
  EXPECT_LE(sink.count, 20 * 2 * StageTouch::kMostPairs * kBodyParts * kBodyParts);
}

TEST(StageTouch, InACrowdTheHousesOwnDancerIsToldOfThePartnerAndNobodyElseIs) {
  TouchingStage stage;
  std::array<GuestId, 40> crowd;
  for (std::size_t i = 0; i < crowd.size(); ++i)
    crowd[i] = guest_named(("guest-" + std::to_string(i)).c_str());
  const Pose lead = with_palm_at(lead_pose(), 0, meeting_place()),
             follow = with_palm_at(follow_pose(), 1, meeting_place());
  for (int picture = 0; picture < 10; ++picture) {
    const MonoTime now = touch_time(16 * picture);
    // All of them within each other.
    for (const GuestId& guest : crowd)
      stage.touch.show(guest, standing(4.0f, 0.0f), now, DancerOf::kAnother);
    stage.touch.show(kBob, follow, now, DancerOf::kAnother);
    stage.touch.show(kAlice, lead, now, DancerOf::kThisHouse);
    stage.touch.update(now, 7, stage.holds, stage.sink);
  }
  EXPECT_GT(stage.count(TouchPhase::kBegins), 0u);
  for (const Told& each : stage.told) {
    EXPECT_EQ(each.guest, kAlice);
    EXPECT_EQ(each.touch.other, kBob);
  }
  // Another one comes into the own dancer's arms and takes the place of one of the crowd.
  const MonoTime now = touch_time(176);
  stage.touch.show(kAlice, lead, now, DancerOf::kThisHouse);
  stage.touch.show(guest_named("late"), standing(-0.2f, 0.0f), now, DancerOf::kAnother);
  stage.touch.update(now, 7, stage.holds, stage.sink);
  EXPECT_EQ(stage.told.back().guest, kAlice);
  EXPECT_TRUE(std::any_of(stage.told.begin(), stage.told.end(), [](const Told& each) {
    return each.touch.other == guest_named("late");
  }));
}

TEST(StageTouch, PosesFarFromAnyBodyMakeNoTouchThatIsNone) {
  TouchingStage stage;
  Pose wild = lead_pose();
  wild.p_WH_m = {999.0f, -999.0f, 999.0f};
  for (int i = 0; i < 5; ++i) {
    stage.show(wild, lead_pose());
    stage.show(lead_pose(), lead_pose());
    stage.ms -= 20;  // and a time that goes back
  }
  SUCCEED();  // every touch was looked at as it came
}

}  // namespace
}  // namespace dance
