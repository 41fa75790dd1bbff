#include "haptics/haptic_player.h"

#include <gtest/gtest.h>

#include "core/net/mono_clock.h"
#include "haptics/haptic_table.h"
#include "tests/haptics/haptic_notes.h"

namespace dance {
namespace {

struct Played {
  DeviceNotes notes;
  std::unique_ptr<Poller> poller = *Poller::create();
  std::unique_ptr<HapticPlayer> player;

  explicit Played(HapticPlayerOptions options = {}) {
    player = std::make_unique<HapticPlayer>(std::make_unique<NotedOutput>(notes), options, *poller);
  }
  void turn_until(std::size_t played) {
    for (int i = 0; i < 500 && notes.played.size() < played; ++i)
      poller->run_once(Duration::ms(20));
  }
};

TEST(HapticPlayer, PlaysInTheOrderOfWhatIsDueAndNeverEarly) {
  Played stage;
  const MonoTime now = mono_now();
  for (const int ms : {30, 10, 20, 0}) {
    Haptic haptic = some_haptic(now + Duration::ms(ms));
    haptic.number = static_cast<std::uint32_t>(ms);
    stage.player->take(haptic, now);
  }
  stage.turn_until(4);
  ASSERT_EQ(stage.notes.played.size(), 4u);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(stage.notes.played[i].number, 10 * i);
    EXPECT_GE(stage.notes.at[i], now + Duration::ms(10 * static_cast<std::int64_t>(i)));
  }
  EXPECT_EQ(stage.player->lateness().count(), 4u);
}

TEST(HapticPlayer, OrdersGoOutAsMuchEarlierAsTheDeviceIsLate) {
  HapticPlayerOptions options;
  options.latency = Duration::ms(300);
  Played stage(options);
  stage.notes.latency = Duration::ms(200);
  const MonoTime now = mono_now();
  stage.player->take(some_haptic(now + Duration::ms(490)), now);  // at once: 10 ms late
  EXPECT_EQ(stage.notes.played.size(), 1u);
  stage.player->take(some_haptic(now + Duration::ms(520)), now);
  EXPECT_EQ(stage.notes.played.size(), 1u);
  stage.turn_until(2);
  ASSERT_EQ(stage.notes.played.size(), 2u);
  EXPECT_GE(stage.notes.at[1], now + Duration::ms(20));
}

TEST(HapticPlayer, HoldsTheLimitAndCountsIt) {
  HapticPlayerOptions options;
  options.strength = 2.0f;
  options.limit = 0.6f;
  Played stage(options);
  const MonoTime now = mono_now();
  Haptic haptic = some_haptic(now);
  stage.player->take(haptic, now);
  haptic.amplitude = 0.2f;
  stage.player->take(haptic, now);
  ASSERT_EQ(stage.notes.played.size(), 2u);
  EXPECT_FLOAT_EQ(stage.notes.played[0].amplitude, 0.6f);
  EXPECT_FLOAT_EQ(stage.notes.played[1].amplitude, 0.4f);
  EXPECT_EQ(stage.player->counters().limited, 1u);
}

TEST(HapticPlayer, WhatEndsAnOrderRunsWhenTheDeviceWantsItNotWithTheNextSecond) {
  Played stage;
  stage.poller->run_once(Duration());  // the second has just begun
  const int works = stage.notes.works;
  const MonoTime now = mono_now();
  stage.player->take(some_haptic(now), now);
  ASSERT_EQ(stage.notes.played.size(), 1u);
  stage.notes.wants = mono_now() + Duration::ms(20);
  stage.poller->run_once(Duration());
  EXPECT_EQ(stage.notes.works, works + 1);
  // Another one that is due meanwhile does not put it off.
  stage.player->take(some_haptic(mono_now()), mono_now());
  stage.poller->run_once(Duration());
  EXPECT_EQ(stage.notes.works, works + 2);
}

TEST(HapticPlayer, OffIsOffAtOnceAndWhatWaitedIsForgotten) {
  Played stage;
  const MonoTime now = mono_now();
  stage.player->take(some_haptic(now + Duration::ms(30)), now);
  stage.player->set_on(false);
  EXPECT_EQ(stage.notes.stops, 1);
  stage.player->take(some_haptic(now), now);
  EXPECT_EQ(stage.player->counters().muted, 1u);
  stage.player->set_on(true);
  for (int i = 0; i < 5; ++i) stage.poller->run_once(Duration::ms(20));
  EXPECT_TRUE(stage.notes.played.empty());
  const Haptic haptic = some_haptic(mono_now());
  stage.player->take(haptic, mono_now());
  EXPECT_EQ(stage.notes.played.size(), 1u);
  stage.player.reset();
  EXPECT_EQ(stage.notes.stops, 2);  // who ends leaves nothing rumbling
}

TEST(HapticPlayer, LeavesOutWhatIsTooLateTooMuchOrRefused) {
  Played stage;
  const MonoTime now = mono_now();
  stage.player->take(some_haptic(now - Duration::ms(500)), now);
  EXPECT_EQ(stage.player->counters().late, 1u);
  for (std::size_t i = 0; i < HapticPlayer::kMostWaiting + 7; ++i)
    stage.player->take(some_haptic(now + Duration::s(5)), now);
  EXPECT_EQ(stage.player->counters().full, 7u);
  stage.notes.refuses = true;
  stage.player->take(some_haptic(now), now);
  EXPECT_EQ(stage.player->counters().refused, 1u);
  const std::string said = stage.player->summary();
  EXPECT_NE(said.find("7 left out as too many waited"), std::string::npos) << said;
}

TEST(HapticPlayer, SaysOnceThatADeviceIsLostAndOnceThatItIsBack) {
  Played stage;
  std::vector<std::string> said;
  stage.player->tell_changes([&](bool, const std::string& line) { said.push_back(line); });
  const MonoTime now = mono_now();
  stage.player->take(some_haptic(now), now);
  EXPECT_TRUE(said.empty());
  stage.notes.is_there = false;
  for (int i = 0; i < 5; ++i) stage.player->take(some_haptic(now), now);
  ASSERT_EQ(said.size(), 1u);
  EXPECT_EQ(said[0], "a device is lost: it is felt again when it is back");
  stage.notes.is_there = true;
  // Also while nothing is played.
  for (int i = 0; i < 500 && said.size() < 2; ++i) stage.poller->run_once(Duration::ms(20));
  ASSERT_EQ(said.size(), 2u);
  EXPECT_EQ(said[1], "a device is there, and felt again");
}

TEST(HapticPlayer, ADeviceThatWasNeverThereIsNotSaidToBeFeltAgain) {
  DeviceNotes notes;
  notes.is_there = false;
  const auto poller = *Poller::create();
  HapticPlayer player(std::make_unique<NotedOutput>(notes), {}, *poller);
  std::vector<std::string> said;
  player.tell_changes([&](bool, const std::string& line) { said.push_back(line); });
  for (const bool is_there : {true, false, true}) {
    const std::size_t before = said.size();
    notes.is_there = is_there;
    for (int i = 0; i < 500 && said.size() == before; ++i) poller->run_once(Duration::ms(20));
  }
  EXPECT_EQ(said, (std::vector<std::string>{"a device is there",
                                            "a device is lost: it is felt again when it is back",
                                            "a device is there, and felt again"}));
}

TEST(HapticPlayer, OneOfSomeBonesLeavesOutTheOthers) {
  HapticPlayerOptions options;
  options.bones = *parse_bones({"leftHand", "leftLowerArm"});
  Played stage(options);
  const MonoTime now = mono_now();
  for (std::size_t bone = 0; bone < kBoneCount; ++bone) {
    Haptic haptic = some_haptic(now);
    haptic.bone = static_cast<Bone>(bone);
    stage.player->take(haptic, now);
  }
  ASSERT_EQ(stage.notes.played.size(), 2u);
  EXPECT_EQ(stage.notes.played[0].bone, Bone::kLeftLowerArm);
  EXPECT_EQ(stage.notes.played[1].bone, Bone::kLeftHand);
  EXPECT_EQ(stage.player->counters().elsewhere, kBoneCount - 2);
  EXPECT_EQ(*parse_bones({}), kAllBones);
  const auto wrong = parse_bones({"left-hand"});
  ASSERT_FALSE(wrong);
  EXPECT_NE(wrong.error().what.find("leftHand"), std::string::npos);
}

TEST(HapticPlayer, ALimitThatIsSetBindsWhatWaits) {
  Played stage;
  const MonoTime now = mono_now();
  stage.player->take(some_haptic(now + Duration::ms(30)), now);
  stage.player->take(some_haptic(now + Duration::ms(40)), now);
  stage.player->set_limit(0.1f);
  stage.turn_until(1);
  stage.player->set_limit(0.3f);
  stage.turn_until(2);
  ASSERT_EQ(stage.notes.played.size(), 2u);
  EXPECT_FLOAT_EQ(stage.notes.played[0].amplitude, 0.1f);
  EXPECT_FLOAT_EQ(stage.notes.played[1].amplitude, 0.3f);
  EXPECT_EQ(stage.player->counters().limited, 2u);
}

TEST(HapticPlayer, ALimitThatIsSetHoldsFromTheNextOrderOn) {
  Played stage;
  const MonoTime now = mono_now();
  stage.player->set_limit(0.2f);
  stage.player->take(some_haptic(now), now);
  EXPECT_FLOAT_EQ(stage.notes.played.at(0).amplitude, 0.2f);
  EXPECT_FLOAT_EQ(stage.notes.limit, 0.2f);
}

}  // namespace
}  // namespace dance
