#include "manager/roster.h"

#include <gtest/gtest.h>

#include <map>
#include <string>

#include "tests/manager/poses.h"

namespace dance {
namespace {

std::map<std::string, GuestStatus> end_second(Roster& roster, MonoTime now) {
  std::map<std::string, GuestStatus> said;
  roster.end_second(now, kClock, [&](const RosterEntry& entry, const GuestStatus& status) {
    said[std::string(entry.guest.view())] = status;
  });
  return said;
}

TEST(Roster, CountsRatesAgesAndGaps) {
  Roster roster;
  for (std::uint32_t i = 0; i < 60; ++i) {
    if (i == 10 || i == 11) continue;  // lost on the way
    const Pose pose = pose_of(i, at_ms(100 + 16 * i));
    RosterEntry* entry = roster.heard(guest("bob"), true, pose, at_ms(107 + 16 * i));
    ASSERT_NE(entry, nullptr);
    Roster::staged(*entry, pose, at_ms(107 + 16 * i), kClock);
  }
  const auto said = end_second(roster, at_ms(1100));
  const GuestStatus& bob = said.at("bob");
  EXPECT_TRUE(bob.alive);
  EXPECT_TRUE(bob.remote);
  EXPECT_EQ(bob.received, 58);
  EXPECT_EQ(bob.lost, 2);
  EXPECT_FLOAT_EQ(bob.arrival_hz, 58.0f);
  EXPECT_FLOAT_EQ(bob.stage_hz, 58.0f);
  EXPECT_NEAR(bob.age_p50_ms, 7.0f, 0.2f);
}

TEST(Roster, DoesNotTakeAProducerThatBeganAgainForALoss) {
  Roster roster;
  roster.heard(guest("a"), false, pose_of(500'000, at_ms(1)), at_ms(1));
  roster.heard(guest("a"), false, pose_of(3, at_ms(2)), at_ms(2));
  roster.heard(guest("a"), false, pose_of(900'000, at_ms(3)), at_ms(3));
  EXPECT_EQ(roster.find(guest("a"))->lost, 0);
}

TEST(Roster, CountsAcrossTheWrapOfTheSequence) {
  Roster roster;
  roster.heard(guest("a"), false, pose_of(0xfffffffe, at_ms(1)), at_ms(1));
  roster.heard(guest("a"), false, pose_of(1, at_ms(2)), at_ms(2));
  EXPECT_EQ(roster.find(guest("a"))->lost, 2);
}

TEST(Roster, SaysOnceThatAGuestWentSilentAndAgainWhenBack) {
  Roster roster;
  roster.heard(guest("a"), false, pose_of(0, at_ms(0)), at_ms(100));
  EXPECT_TRUE(end_second(roster, at_ms(1000)).at("a").alive);
  EXPECT_FALSE(end_second(roster, at_ms(2200)).at("a").alive);
  EXPECT_TRUE(end_second(roster, at_ms(3000)).empty());
  EXPECT_EQ(roster.alive_count(), 0);
  roster.heard(guest("a"), false, pose_of(1, at_ms(3500)), at_ms(3500));
  EXPECT_TRUE(end_second(roster, at_ms(4000)).at("a").alive);
}

TEST(Roster, LeavesAgesOfReplaysAndForeignClocksOut) {
  Roster roster;
  Pose old = pose_of(0, at_ms(100));
  RosterEntry* entry = roster.heard(guest("a"), false, old, at_ms(60'000));
  Roster::staged(*entry, old, at_ms(60'000), kClock);
  Pose foreign = pose_of(1, at_ms(59'990));
  foreign.clock_id = 6;
  Roster::staged(*entry, foreign, at_ms(60'000), kClock);
  EXPECT_EQ(entry->age.count(), 0u);
}

TEST(Roster, RefusesAGuestTooManyAndGivesASilentPlaceAway) {
  Roster roster;
  for (std::size_t i = 0; i < kMaxGuests; ++i)
    ASSERT_NE(roster.heard(guest("g" + std::to_string(i)), true, pose_of(0, at_ms(0)),
                           at_ms(i == 3 ? 100 : 3000)),
              nullptr);
  EXPECT_EQ(roster.heard(guest("late"), true, pose_of(0, at_ms(0)), at_ms(3000)), nullptr);
  end_second(roster, at_ms(3100));  // g3 has been silent for 3 s
  EXPECT_NE(roster.heard(guest("late"), true, pose_of(0, at_ms(0)), at_ms(3200)), nullptr);
  EXPECT_EQ(roster.find(guest("g3")), nullptr);
}

}  // namespace
}  // namespace dance
