#include "haptics/haptic_feed.h"

#include <gtest/gtest.h>

#include "core/net/mono_clock.h"
#include "haptics/haptic_table.h"
#include "tests/core/bus/port_double.h"
#include "tests/haptics/haptic_notes.h"

namespace dance {
namespace {

const GuestId kAlice = *GuestId::parse("alice");

struct Felt {
  PortDouble port;
  std::unique_ptr<Poller> poller = *Poller::create();
  DeviceNotes notes;
  HapticFeed feed;
  explicit Felt(HapticMakerOptions options = {}) : feed(kAlice, options, port, *poller) {
    feed.add(std::make_unique<HapticPlayer>(std::make_unique<NotedOutput>(notes),
                                            HapticPlayerOptions(), *poller));
  }
  void touch(std::uint32_t contact, std::uint64_t clock = this_clock_id(),
             const char* other = "bob") {
    Touch touch;
    touch.time = mono_now();
    touch.clock_id = clock;
    touch.contact = contact;
    touch.bone = static_cast<Bone>(contact % kBoneCount);
    touch.force_n = 10.0f;
    touch.other = *GuestId::parse(other);
    port.publish(Where::kStage, kAlice, touch);
  }
  void hear(std::uint64_t maker, HapticSource source = HapticSource::kTouch) {
    Haptic haptic = some_haptic(mono_now());
    haptic.source = source;
    haptic.clock_id = this_clock_id();
    haptic.maker = maker;
    port.publish(Where::kCapture, kAlice, haptic);
  }
  std::size_t said() const {
    return static_cast<std::size_t>(
        std::count(port.sent.begin(), port.sent.end(), "HAPTIC/capture/alice"));
  }
};

TEST(HapticFeed, MakesPlaysAndSaysWhatIsTouched) {
  Felt felt;
  felt.touch(1);
  felt.port.publish(Where::kStage, *GuestId::parse("bob"), [] {
    Touch touch;
    touch.clock_id = this_clock_id();
    touch.other = kAlice;
    return touch;
  }());  // bob's is bob's
  EXPECT_EQ(felt.notes.played.size(), 1u);
  EXPECT_EQ(felt.said(), 1u);  // and its own is not played again
  felt.touch(2, 12345);
  EXPECT_EQ(felt.notes.played.size(), 1u);
  EXPECT_EQ(felt.feed.of_other_clocks(), 1u);
}

TEST(HapticFeed, AReplaysAreFeltAsTheyWereAndNothingIsMadeBeside) {
  Felt felt;
  felt.hear(0);
  EXPECT_EQ(felt.notes.played.size(), 1u);
  felt.touch(1);
  EXPECT_EQ(felt.feed.made(), 0u);
  EXPECT_EQ(felt.notes.played.size(), 1u);
}

TEST(HapticFeed, OfSeveralMakersOneMakes) {
  Felt felt;
  felt.hear(~std::uint64_t{0});  // the largest number there is: this one makes
  EXPECT_EQ(felt.notes.played.size(), 0u);
  felt.touch(1);
  EXPECT_EQ(felt.notes.played.size(), 1u);
}

TEST(HapticFeed, AnotherMakerIsNotForgottenWhileItIsQuietButWhenItIsGone) {
  Felt felt;
  felt.hear(1);
  for (int i = 0; i < HapticFeed::kMostRested; ++i) {
    felt.touch(static_cast<std::uint32_t>(i));
    EXPECT_EQ(felt.feed.made(), 0u);
  }
  felt.touch(77);
  EXPECT_EQ(felt.feed.made(), 1u);
  EXPECT_EQ(felt.notes.played.size(), 2u);
}

TEST(HapticFeed, WhatTwoMakersOrderForOnePlaceIsFeltOnce) {
  Felt felt;
  felt.touch(1);
  ASSERT_EQ(felt.notes.played.size(), 1u);
  // The same touch, of a maker that came later.
  Haptic same = felt.notes.played[0];
  same.maker = 1;
  same.play_time += Duration::ms(59);
  felt.port.publish(Where::kCapture, kAlice, same);
  EXPECT_EQ(felt.feed.twice(), 1u);
  EXPECT_EQ(felt.notes.played.size(), 1u);
  // Elsewhere it is another one, and one maker's own may be as near to each other as it says.
  same.bone = Bone::kHead;
  felt.port.publish(Where::kCapture, kAlice, same);
  felt.port.publish(Where::kCapture, kAlice, same);
  EXPECT_EQ(felt.feed.twice(), 1u);
  EXPECT_EQ(felt.feed.heard(), 3u);
}

TEST(HapticFeed, ADeviceFeelsOnlyWhatItsOptionsNameOfAnyMaker) {
  Felt felt(HapticMakerOptions{false, false, FeltBeats::kOne});
  felt.hear(1, HapticSource::kTouch);
  felt.hear(1, HapticSource::kLead);
  felt.touch(1);
  EXPECT_EQ(felt.notes.played.size(), 0u);
  felt.hear(1, HapticSource::kBeat);
  EXPECT_EQ(felt.notes.played.size(), 1u);
}

// Whatever the number of the other live maker: below every other, or above.
TEST(HapticFeed, OneThatIsToFeelOnlyBobTakesNoTouchesOfAnotherMakerAndSaysNone) {
  for (const std::uint64_t maker : {std::uint64_t{1}, ~std::uint64_t{0}}) {
    HapticMakerOptions options;
    options.from = {*GuestId::parse("bob")};
    Felt felt(options);
    for (const HapticSource source :
         {HapticSource::kTouch, HapticSource::kHold, HapticSource::kLead})
      felt.hear(maker, source);
    EXPECT_TRUE(felt.notes.played.empty());
    const std::size_t heard = felt.said();
    felt.touch(1, this_clock_id(), "eve");
    EXPECT_TRUE(felt.notes.played.empty());
    felt.touch(2);
    EXPECT_EQ(felt.notes.played.size(), 1u);  // it does not rest for the other
    EXPECT_EQ(felt.said(), heard);
    felt.hear(0);  // a replay's are what was felt
    EXPECT_EQ(felt.notes.played.size(), 2u);
  }
}

// As two [[haptics]] of one house: two makers on one bus, whose numbers are drawn.
TEST(HapticFeed, OfTwoOfOneGuestEachFeelsThoseThatItIsToFeel) {
  bool has_been_first = false, has_been_second = false;
  for (int i = 0; i < 64; ++i) {
    HapticMakerOptions options;
    options.from = {*GuestId::parse("bob")};
    Felt all;
    DeviceNotes notes;
    HapticFeed bobs(kAlice, options, all.port, *all.poller);
    bobs.add(std::make_unique<HapticPlayer>(std::make_unique<NotedOutput>(notes),
                                            HapticPlayerOptions(), *all.poller));
    all.touch(1, this_clock_id(), "eve");
    EXPECT_EQ(notes.played.size(), 0u);
    all.touch(2);
    all.touch(3, this_clock_id(), "eve");
    EXPECT_EQ(all.notes.played.size(), 3u);
    ASSERT_EQ(notes.played.size(), 1u);
    EXPECT_EQ(all.said(), 3u);
    const bool is_first = notes.played[0].maker < all.notes.played[0].maker;
    has_been_first |= is_first;
    has_been_second |= !is_first;
  }
  EXPECT_TRUE(has_been_first && has_been_second);
}

TEST(HapticTable, NamesWhatIsWrong) {
  HapticOptions options;
  options.device = "pad";
  EXPECT_NE(check_haptic_options("osc", options).error().what.find("address"), std::string::npos);
  EXPECT_NE(check_haptic_options("glove", {}).error().what.find("evdev, osc, bhaptics, sound"),
            std::string::npos);
  options = {};
  options.address = "1.2.3.4:5";
  EXPECT_FALSE(check_haptic_options("evdev", options));
  EXPECT_FALSE(parse_felt({"touch", "smell"}));
  const auto felt = parse_felt({"lead", "beats"});
  ASSERT_TRUE(felt);
  EXPECT_FALSE(felt->touch);
  EXPECT_TRUE(felt->lead);
  EXPECT_EQ(felt->beats, FeltBeats::kAll);
  options = {};
  options.address = "no such host at all:x";
  EXPECT_FALSE(make_haptic_output("osc", options));
}

}  // namespace
}  // namespace dance
