// The router and what stands beside its guests: the dancers of this house, and words on what is
// shown.
#include <gtest/gtest.h>

#include <algorithm>

#include "producers/salsa/salsa_dancer.h"
#include "tests/manager/router_stage.h"

namespace dance {
namespace {

// A remote follow, and the lead who dances here or is not seen.
std::vector<Pose> shown_beside(bool is_seen, const char* words) {
  Stage stage;
  Router router({held(words)}, kClock, stage);
  SalsaStyle style;
  SalsaDancer lead{style};
  style.role = SalsaRole::kFollow;
  SalsaDancer follow{style};
  router.take(Where::kGuest, guest("bob"),
              TimedSkeleton{salsa_skeleton(SalsaRole::kFollow, 1), at_ms(1), kClock});
  for (int i = 0; i < 600; ++i) {
    const MonoTime now = at_ms(1000 + 16 * i);
    Pose pose;
    lead.dance_at(Duration::ms(16 * i), pose);
    pose.capture_time = now;
    pose.clock_id = kClock;
    if (is_seen) router.take(Where::kCapture, guest("alice"), pose, now);
    if (i >= 12) {
      follow.dance_at(Duration::ms(16 * (i - 12)), pose);
      pose.capture_time = at_ms(1000 + 16 * (i - 12));
      router.take(Where::kGuest, guest("bob"), pose, now);
    }
    router.tick(0, now);
  }
  std::vector<Pose> poses;
  for (const auto& [name, pose] : stage.poses) poses.push_back(pose);
  return poses;
}

TEST(Router, TellsWhatIsShownOfGuestsAndWhy) {
  Stage stage;
  Router router({held("predict"), pass_through(Where::kCapture)}, kClock, stage);
  router.take(Where::kCapture, guest("alice"), pose_of(0, at_ms(1)), at_ms(1));
  for (std::uint32_t i = 0; i < 90; ++i) {
    router.take(Where::kGuest, guest("bob"), pose_of(0, at_ms(10.0 * i)), at_ms(10.0 * i + 80.0));
    router.tick(0, at_ms(10.0 * i + 80.0));
  }
  std::vector<std::pair<GuestId, Playout>> told;
  router.tell_playouts(at_ms(980), [&](const GuestId& name, const Playout& playout) {
    told.emplace_back(name, playout);
  });
  ASSERT_EQ(told.size(), 1u);  // of those whose poses go as they come there is nothing to tell
  EXPECT_EQ(told[0].first, guest("bob"));
  EXPECT_TRUE(is_valid(told[0].second));
  EXPECT_EQ(told[0].second.reason, PlayoutReason::kNoRhythm);
  EXPECT_NEAR(told[0].second.delay_ms, 0.0f, 1.0f);
  EXPECT_NEAR(told[0].second.ahead_ms, 80.0f, 1.0f);
}

TEST(Router, PredictsGuestsBesideTheDancersOfThisHouse) {
  const auto alone = shown_beside(false, "predict"), beside = shown_beside(true, "predict");
  ASSERT_EQ(alone.size(), beside.size());
  const auto arm = [](const Pose& pose) { return pose.R_PB[index_of(Bone::kLeftUpperArm)]; };
  double apart = 0.0;
  for (std::size_t i = 300; i < alone.size(); ++i)
    apart = std::max(apart, static_cast<double>(arm(alone[i]).angularDistance(arm(beside[i]))));
  EXPECT_GT(apart, 0.02);
  const auto off = shown_beside(true, "predict partner=0");
  for (std::size_t i = 0; i < off.size(); ++i)
    EXPECT_TRUE(arm(alone[i]).coeffs() == arm(off[i]).coeffs());
}

TEST(Router, WhoDancesBesideTheStageIsNotOnIt) {
  Stage stage;
  Router router({held("predict")}, kClock, stage);
  EXPECT_TRUE(router.wants(Where::kCapture));
  for (int i = 0; i < 30; ++i)
    router.take(Where::kCapture, guest("alice"), pose_of(0, at_ms(10 * i)), at_ms(10 * i));
  EXPECT_EQ(router.stats().guests, 0);
  EXPECT_EQ(router.stats().received, 0);
  EXPECT_EQ(router.roster().find(guest("alice")), nullptr);
  // Where nobody is predicted, nobody here is listened to.
  EXPECT_FALSE(Router({held("hold")}, kClock, stage).wants(Where::kCapture));
  EXPECT_FALSE(Router({held("predict partner=0")}, kClock, stage).wants(Where::kCapture));
}

}  // namespace
}  // namespace dance
