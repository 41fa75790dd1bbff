#include "haptics/haptic_maker.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "tests/allocation_guard.h"
#include "tests/haptics/haptic_notes.h"

namespace dance {
namespace {

MonoTime when(std::int64_t ms) { return MonoTime::from_us(5'000'000 + 1000 * ms); }

Touch some_touch(TouchPhase phase, float force_n = 10.0f) {
  Touch touch;
  touch.time = when(0);
  touch.contact = 4;
  touch.phase = phase;
  touch.bone = Bone::kRightHand;
  touch.other_bone = Bone::kLeftHand;
  touch.force_n = force_n;
  touch.other = *GuestId::parse("bob");
  return touch;
}

Touch some_hold(TouchPhase phase, const Eigen::Vector3f& motion = Eigen::Vector3f::Zero()) {
  Touch touch = some_touch(phase);
  touch.is_hold = true;
  touch.motion_m_s = motion;
  return touch;
}

Beat some_beat(double number, MonoTime at) {
  Beat beat;
  beat.time = at - Duration::ms(100);
  beat.clock_id = 1;
  beat.beat_time = at;
  beat.beat = number;
  beat.tempo_bpm = 120.0;
  beat.beats_per_bar = 4;
  beat.confidence = 1.0f;
  beat.playing = true;
  return beat;
}

HapticMaker maker_of(HapticMakerOptions options = {}) { return HapticMaker(options, 9, 1); }

TEST(HapticMaker, AHarderTouchIsFeltMoreStronglyWhereItIs) {
  HapticMaker maker = maker_of();
  HapticNotes soft, hard;
  maker.take(some_touch(TouchPhase::kBegins, 2.0f), when(0), soft);
  maker.take(some_touch(TouchPhase::kBegins, 40.0f), when(200), hard);
  ASSERT_EQ(soft.felt.size(), 1u);
  ASSERT_EQ(hard.felt.size(), 1u);
  EXPECT_GT(hard.felt[0].amplitude, soft.felt[0].amplitude + 0.3f);
  EXPECT_EQ(hard.felt[0].bone, Bone::kRightHand);
  EXPECT_EQ(hard.felt[0].maker, 9u);
  EXPECT_EQ(hard.felt[0].play_time, when(200));
  for (const Haptic& haptic : {soft.felt[0], hard.felt[0]}) EXPECT_TRUE(is_valid(haptic));
}

TEST(HapticMaker, WhatStaysFades) {
  HapticMaker maker = maker_of();
  HapticNotes notes;
  maker.take(some_touch(TouchPhase::kBegins), when(0), notes);
  for (int ms = 33; ms < 10'000; ms += 33)
    maker.take(some_touch(TouchPhase::kLasts), when(ms), notes);
  EXPECT_GT(notes.felt.size(), 4u);
  EXPECT_LT(notes.felt.size(), 30u);
  EXPECT_LT(notes.felt.back().amplitude, 0.35f * notes.felt[1].amplitude);
  EXPECT_LT(notes.felt.back().time, when(4000));
}

TEST(HapticMaker, TheLeadsHandHasAPatternForEachDirection) {
  const auto patterns = [](const Eigen::Vector3f& motion) {
    HapticMaker maker = maker_of();
    HapticNotes notes;
    maker.take(some_hold(TouchPhase::kBegins), when(0), notes);
    notes.felt.clear();
    maker.take(some_hold(TouchPhase::kLasts, motion), when(400), notes);
    maker.take(some_hold(TouchPhase::kLasts, motion), when(433), notes);  // not twice
    return notes.felt;
  };
  EXPECT_TRUE(patterns({0.1f, 0.2f, 0.3f}).empty());
  const auto push = patterns({0.0f, 0.0f, -1.0f}), pull = patterns({0.0f, 0.0f, 1.0f}),
             raise = patterns({0.0f, 1.0f, 0.0f}), side = patterns({1.0f, 0.0f, 0.0f});
  ASSERT_EQ(push.size(), 1u);
  ASSERT_EQ(pull.size(), 1u);
  ASSERT_EQ(side.size(), 1u);
  ASSERT_EQ(raise.size(), 2u);  // twice, the second one higher
  EXPECT_GT(raise[1].frequency_hz, raise[0].frequency_hz);
  EXPECT_GT(raise[1].play_time, raise[0].play_time);
  EXPECT_GT(pull[0].attack, push[0].attack);
  EXPECT_GT(pull[0].duration, push[0].duration);
  for (const Haptic& haptic : {push[0], pull[0], raise[0], side[0]}) {
    EXPECT_EQ(haptic.source, HapticSource::kLead);
    EXPECT_TRUE(is_valid(haptic));
  }
  EXPECT_GT(patterns({0.0f, 0.0f, -2.5f})[0].amplitude, push[0].amplitude);
}

TEST(HapticMaker, TheOneIsOrderedAheadOnceAndAtItsTime) {
  HapticMaker maker = maker_of();
  HapticNotes notes;
  // A beat each half second, number 0 at 0 ms.
  for (int ms = 0; ms < 8000; ms += 50) {
    const double next = std::ceil(ms / 500.0);
    maker.hear(some_beat(next, when(static_cast<std::int64_t>(500 * next))));
    maker.look_ahead(when(ms), notes);
  }
  ASSERT_EQ(notes.felt.size(), 5u);
  for (std::size_t i = 0; i < notes.felt.size(); ++i) {
    EXPECT_NEAR((notes.felt[i].play_time - when(2000 * static_cast<std::int64_t>(i))).as_ms(), 0.0,
                1.0);
    EXPECT_EQ(notes.felt[i].source, HapticSource::kBeat);
    EXPECT_TRUE(is_valid(notes.felt[i]));
    if (i > 0) {
      EXPECT_GT(notes.felt[i].play_time - notes.felt[i].time, Duration::ms(300));
    }
  }
}

TEST(HapticMaker, OtherBeatsAreFeltWhereTheyAreAskedForAndNoneWithoutMusic) {
  HapticMakerOptions options;
  options.beats = FeltBeats::kAll;
  HapticMaker maker = maker_of(options);
  HapticNotes notes;
  maker.look_ahead(when(0), notes);
  EXPECT_TRUE(notes.felt.empty());
  maker.hear(some_beat(4.0, when(100)));
  maker.look_ahead(when(0), notes);
  maker.look_ahead(when(300), notes);
  ASSERT_EQ(notes.felt.size(), 2u);
  EXPECT_GT(notes.felt[0].amplitude, notes.felt[1].amplitude);
  options.beats = FeltBeats::kNone;
  HapticMaker none = maker_of(options);
  none.hear(some_beat(4.0, when(100)));
  none.look_ahead(when(0), notes);
  EXPECT_EQ(notes.felt.size(), 2u);
}

// Another dancer who lets each of many contacts begin and end at every picture.
HapticNotes jittered(HapticMaker& maker, int bones, bool is_hold, int pictures = 600) {
  HapticNotes notes;
  for (int picture = 0; picture < pictures; ++picture)
    for (int bone = 0; bone < bones; ++bone) {
      Touch touch = some_touch(picture % 2 == 0 ? TouchPhase::kBegins : TouchPhase::kEnded, 200.0f);
      touch.is_hold = is_hold;
      touch.bone = static_cast<Bone>(bone);
      touch.contact = static_cast<std::uint32_t>(1000 * picture + bone);
      touch.other = *GuestId::parse("eve");
      maker.take(touch, when(16 * picture), notes);
    }
  return notes;
}

TEST(HapticMaker, AStrangerWhoJittersIsFeltNoMoreOftenThanAPlaceAndABodyBear) {
  for (const bool is_hold : {false, true}) {
    HapticMaker one_place = maker_of(), all_places = maker_of();
    const HapticNotes one = jittered(one_place, 1, is_hold);
    ASSERT_GT(one.felt.size(), 40u);
    for (std::size_t i = 1; i < one.felt.size(); ++i)
      EXPECT_GE(one.felt[i].time - one.felt[i - 1].time, HapticMaker::kBetweenAtPlace);
    const HapticNotes all = jittered(all_places, 22, is_hold);
    const double seconds = 600 * 0.016;
    EXPECT_LE(all.felt.size(),
              is_hold ? HapticMaker::kHolds_hz * seconds + HapticMaker::kHoldsAtOnce + 1.0
                      : HapticMaker::kTouches_hz * seconds + HapticMaker::kTouchesAtOnce + 1.0);
    EXPECT_GT(all_places.left_out(), 1000u);
  }
}

// Of several strangers each jitters as one does alone.
TEST(HapticMaker, StrangersTogetherAreBoundedToo) {
  HapticMaker maker = maker_of();
  HapticNotes notes;
  const auto jitter = [&](const std::string& name, int ms) {
    for (int bone = 0; bone < 22; ++bone) {
      Touch touch = some_touch(TouchPhase::kBegins, 200.0f);
      touch.bone = static_cast<Bone>(bone);
      touch.contact = static_cast<std::uint32_t>(100 * ms + bone);
      touch.other = *GuestId::parse(name);
      maker.take(touch, when(ms), notes);
    }
  };
  for (int picture = 0; picture < 600; ++picture)
    for (int stranger = 0; stranger < 40; ++stranger)  // more than are counted apart
      jitter("eve-" + std::to_string(stranger), 16 * picture);
  EXPECT_GT(notes.felt.size(), 200u);
  EXPECT_LE(notes.felt.size(),
            HapticMaker::kAllTouches_hz * 9.6 + HapticMaker::kAllTouchesAtOnce + 1.0);
}

TEST(HapticMaker, ALeadsHandThatIsEverANewContactIsBoundedToo) {
  HapticMaker maker = maker_of();
  HapticNotes notes;
  for (int i = 0; i < 600; ++i) {
    Touch touch = some_hold(TouchPhase::kLasts, {0.0f, 0.0f, -3.0f});
    touch.contact = static_cast<std::uint32_t>(i / 2);
    maker.take(touch, when(16 * i), notes);
  }
  EXPECT_LE(notes.felt.size(), HapticMaker::kHolds_hz * 9.6 + HapticMaker::kHoldsAtOnce + 1.0);
}

// Eve does all that she can beside: touches and holds at all places, new ones in each picture, ever
// in front of bob's.
TEST(HapticMaker, ThePartnerIsFeltBesideAStrangerWhoJitters) {
  for (const bool eve_holds : {false, true}) {
    HapticMaker maker = maker_of();
    HapticNotes of_eve, of_bob;
    int pushes = 0;
    for (int picture = 0; picture < 600; ++picture) {
      for (std::uint32_t i = 0; i < 44; ++i) {
        Touch touch = some_touch(i % 2 == 0 ? TouchPhase::kBegins : TouchPhase::kLasts, 200.0f);
        touch.is_hold = eve_holds;
        touch.motion_m_s = {0.0f, 0.0f, 3.0f};
        touch.bone = static_cast<Bone>(i / 2);
        touch.contact = 100u * static_cast<std::uint32_t>(picture) + i / 2;
        touch.other = *GuestId::parse("eve");
        maker.take(touch, when(16 * picture), of_eve);
      }
      // A hold from the first second on, with a push each half second.
      if (picture < 60 || picture % 2 != 0) continue;
      const bool is_push = picture % 30 == 0;
      const TouchPhase phase = picture == 60 ? TouchPhase::kBegins : TouchPhase::kLasts;
      maker.take(some_hold(phase, {0.0f, 0.0f, is_push ? -1.5f : 0.0f}), when(16 * picture),
                 of_bob);
      pushes += is_push && phase == TouchPhase::kLasts;
    }
    ASSERT_FALSE(of_bob.felt.empty());
    EXPECT_EQ(of_bob.felt[0].source, HapticSource::kHold);
    EXPECT_EQ(of_bob.felt.size(), 1u + static_cast<std::size_t>(pushes));
    EXPECT_GT(pushes, 10);
    // A tap elsewhere is felt, too.
    HapticNotes tap;
    maker.take(some_touch(TouchPhase::kBegins), when(16 * 600 + 100), tap);
    EXPECT_EQ(tap.felt.size(), 1u);
  }
}

// Where bodies are close, each contact goes on to be felt: the lead's hand has its own share.
TEST(HapticMaker, CloseContactDoesNotHideTheLeadOfTheSameDancer) {
  HapticMaker maker = maker_of();
  HapticNotes touches, lead;
  for (int picture = 0; picture < 60; ++picture) {
    for (std::uint32_t i = 0; i < 40; ++i) {
      Touch touch = some_touch(picture == 0 ? TouchPhase::kBegins : TouchPhase::kLasts, 40.0f);
      touch.bone = static_cast<Bone>(i % kBoneCount);
      touch.contact = 100 + i;
      maker.take(touch, when(33 * picture), touches);
    }
    const bool is_push = picture % 20 == 19;
    maker.take(some_hold(TouchPhase::kLasts, {0.0f, 0.0f, is_push ? -1.5f : 0.0f}),
               when(33 * picture), lead);
  }
  EXPECT_GT(touches.felt.size(), 20u);
  EXPECT_EQ(std::count_if(lead.felt.begin(), lead.felt.end(),
                          [](const Haptic& h) { return h.source == HapticSource::kLead; }),
            3);
}

TEST(HapticMaker, ASignalThatIsNotFeltAtOnceIsFeltWithTheNextMessage) {
  HapticMaker maker = maker_of();
  HapticNotes notes;
  const auto hold = [&](std::uint32_t contact, TouchPhase phase, float forward_m_s, int ms) {
    Touch touch = some_hold(phase, {0.0f, 0.0f, forward_m_s});
    touch.contact = contact;
    maker.take(touch, when(ms), notes);
  };
  hold(1, TouchPhase::kBegins, 0.0f, 0);
  hold(2, TouchPhase::kBegins, 0.0f, 200);
  notes.felt.clear();
  hold(1, TouchPhase::kLasts, -1.5f, 400);
  hold(2, TouchPhase::kLasts, -1.5f, 460);  // at the same place, too soon
  EXPECT_EQ(notes.felt.size(), 1u);
  hold(2, TouchPhase::kLasts, -1.5f, 510);
  EXPECT_EQ(notes.felt.size(), 2u);
}

TEST(HapticMaker, OnlyThoseWhoAreNamedAreFelt) {
  HapticMakerOptions options;
  options.from = {*GuestId::parse("bob")};
  HapticMaker maker = maker_of(options);
  EXPECT_TRUE(jittered(maker, 3, false).felt.empty());
  HapticNotes notes;
  maker.take(some_touch(TouchPhase::kBegins), when(0), notes);  // bob's
  EXPECT_EQ(notes.felt.size(), 1u);
}

TEST(HapticMaker, MoreContactsThanThereIsRoomForAreBoundedAndNothingIsAllocated) {
  HapticMaker maker = maker_of();
  struct Count final : HapticSink {
    void on_haptic(const Haptic& haptic) override {
      ++count;
      is_fine = is_fine && is_valid(haptic);
    }
    int count = 0;
    bool is_fine = true;
  } sink;
  const AllocationGuard guard;
  for (std::uint32_t i = 0; i < 5000; ++i) {
    Touch touch = some_touch(i % 3 == 0 ? TouchPhase::kBegins : TouchPhase::kLasts, 200.0f);
    touch.contact = i % 100;
    touch.is_hold = i % 2 == 0;
    touch.motion_m_s = {50.0f, -50.0f, 50.0f};
    maker.take(touch, when(100 * i), sink);
  }
  EXPECT_EQ(guard.allocations(), 0u);
  EXPECT_TRUE(sink.is_fine);
  EXPECT_GT(sink.count, 100);
}

}  // namespace
}  // namespace dance
