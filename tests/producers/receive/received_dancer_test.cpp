#include "producers/receive/received_dancer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "core/net/one_way_clock.h"
#include "tests/allocation_guard.h"
#include "tests/producers/receive/kept_captures.h"

namespace dance {
namespace {

const GuestId kAlice = *GuestId::parse("alice");

MonoTime at_ms(std::int64_t ms) { return MonoTime::from_us(7'000'000) + Duration::ms(ms); }

TEST(ReceivedDancer, NumbersAndStampsPosesFarAboveThoseOfAnEarlierRun) {
  KeptCaptures kept;
  ReceivedDancer dancer(kAlice, kept);
  for (int i = 0; i < 3; ++i) {
    Pose pose;
    pose.R_PB[3] = Eigen::Quaternionf(1.005f, 0.0f, 0.0f, 0.0f);
    EXPECT_TRUE(dancer.capture(pose, at_ms(10 * i), at_ms(10 * i + 4)));
  }
  ASSERT_EQ(kept.poses.size(), 3u);
  EXPECT_EQ(kept.guests[0], kAlice);
  EXPECT_EQ(kept.poses[0].sequence, 70'040u);
  EXPECT_EQ(kept.poses[2].sequence, 70'042u);
  EXPECT_EQ(kept.poses[1].capture_time, at_ms(10));
  EXPECT_EQ(kept.poses[1].clock_id, this_clock_id());
  EXPECT_FLOAT_EQ(kept.poses[0].R_PB[3].w(), 1.0f);
}

TEST(ReceivedDancer, PublishesProportionsBeforeTheFirstPoseEachSecondAndWhenTheyChange) {
  KeptCaptures kept;
  ReceivedDancer dancer(kAlice, kept);
  EXPECT_FALSE(dancer.has_skeleton());
  dancer.set_skeleton(average_skeleton(1.6f));
  EXPECT_TRUE(kept.skeletons.empty());
  for (int i = 0; i < 30; ++i) {
    dancer.set_skeleton(average_skeleton(i < 25 ? 1.6f : 1.7f));
    Pose pose;
    dancer.capture(pose, at_ms(100 * i), at_ms(100 * i));
  }
  // At 0, 1000, 2000 and 2500 ms, each before the pose.
  EXPECT_EQ(kept.poses_before_skeleton, (std::vector<std::size_t>{0, 10, 20, 25}));
  EXPECT_EQ(kept.skeletons[2].skeleton.version, 1u);
  EXPECT_EQ(kept.skeletons[3].skeleton.version, 2u);
  EXPECT_TRUE(dancer.has_skeleton());
}

TEST(ReceivedDancer, PublishesAtMostOneChangedSkeletonASecondAndTheLast) {
  KeptCaptures kept;
  ReceivedDancer dancer(kAlice, kept);
  for (int i = 0; i < 400; ++i) {
    dancer.set_skeleton(average_skeleton(1.6f + 0.0005f * static_cast<float>(std::min(i, 250))));
    Pose pose;
    dancer.capture(pose, at_ms(10 * i), at_ms(10 * i));
  }
  ASSERT_EQ(kept.skeletons.size(), 4u);
  EXPECT_EQ(kept.poses_before_skeleton, (std::vector<std::size_t>{0, 100, 200, 300}));
  Skeleton last = average_skeleton(1.6f + 0.0005f * 250.0f);
  last.version = 4;
  EXPECT_TRUE(kept.skeletons[3].skeleton == last);
  EXPECT_EQ(dancer.counters().skeletons_left_out, 251u - 4u);
}

// The stamps of a game engine fall back as its clock does: what is dropped lasts no longer.
TEST(ReceivedDancer, AfterAClockFellBackPosesAreMissingNoLongerThanThat) {
  for (const int back_ms : {300, 667, 900, 1500}) {
    KeptCaptures kept;
    ReceivedDancer dancer(kAlice, kept);
    OneWayClock clock;
    for (int i = 0; i < 1000; ++i) {
      const std::int64_t sent_ms = 10 * i;
      Pose pose;
      dancer.capture(pose,
                     clock.to_ours((sent_ms - (i < 500 ? 0 : back_ms)) * 1000, at_ms(sent_ms)),
                     at_ms(sent_ms));
    }
    EXPECT_LE(dancer.counters().not_newer, static_cast<std::uint64_t>(back_ms / 10));
    EXPECT_EQ(kept.poses.back().capture_time, at_ms(9990)) << back_ms;
  }
}

TEST(ReceivedDancer, DropsAndCountsWhatIsNotValidOrNotNewer) {
  KeptCaptures kept;
  ReceivedDancer dancer(kAlice, kept);
  Pose pose;
  EXPECT_TRUE(dancer.capture(pose, at_ms(10), at_ms(10)));
  EXPECT_FALSE(dancer.capture(pose, at_ms(10), at_ms(11)));
  EXPECT_FALSE(dancer.capture(pose, at_ms(9), at_ms(12)));
  Pose broken;
  broken.p_WH_m.x() = std::numeric_limits<float>::quiet_NaN();
  EXPECT_FALSE(dancer.capture(broken, at_ms(20), at_ms(20)));
  Skeleton endless = average_skeleton();
  endless.offset_m[4].y() = 1e6f;
  dancer.set_skeleton(endless);
  Hands no_hands;
  no_hands.R_PB[0] = Eigen::Quaternionf(0.0f, 0.0f, 0.0f, 0.0f);
  EXPECT_FALSE(dancer.capture(no_hands));
  EXPECT_EQ(kept.poses.size(), 1u);
  EXPECT_TRUE(kept.hands.empty());
  EXPECT_EQ(dancer.counters().poses, 1u);
  EXPECT_EQ(dancer.counters().not_newer, 2u);
  EXPECT_EQ(dancer.counters().invalid, 3u);
  EXPECT_FALSE(dancer.has_skeleton());
}

TEST(ReceivedDancer, GivesHandsTheNumberOfTheirPose) {
  KeptCaptures kept;
  ReceivedDancer dancer(kAlice, kept);
  Pose pose;
  dancer.capture(pose, at_ms(10), at_ms(10));
  Hands hands;
  EXPECT_TRUE(dancer.capture(hands));
  ASSERT_EQ(kept.hands.size(), 1u);
  EXPECT_EQ(kept.hands[0].sequence, kept.poses[0].sequence);
  EXPECT_EQ(kept.hands[0].capture_time, at_ms(10));
}

TEST(ReceivedDancer, AllocatesNothing) {
  LastCapture last;
  ReceivedDancer dancer(kAlice, last);
  const Skeleton skeleton = average_skeleton(1.6f);
  const AllocationGuard guard;
  for (int i = 0; i < 100; ++i) {
    Pose pose;
    dancer.set_skeleton(skeleton);
    dancer.capture(pose, at_ms(20 * i), at_ms(20 * i));
  }
  EXPECT_EQ(guard.allocations(), 0u);
  EXPECT_EQ(last.count, 100);
}

}  // namespace
}  // namespace dance
