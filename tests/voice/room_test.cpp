#include <gtest/gtest.h>

#include <cmath>

#include "testing/voice/sound_match.h"
#include "testing/voice/voice_stream.h"
#include "tests/voice/voices.h"
#include "voice/room/own_voice.h"
#include "voice/room/replayed_voices.h"
#include "voice/room/room_voices.h"
#include "voice/room/voice_settings.h"

namespace dance {
namespace {

TEST(VoiceSettings, TakesItsCommandsAndNoOthers) {
  VoiceSettings settings;
  const MonoTime now = MonoTime::from_us(1'000'000);
  EXPECT_TRUE(settings.sends(now));
  ASSERT_TRUE(settings.apply("mute", now));
  EXPECT_FALSE(settings.sends(now));
  ASSERT_TRUE(settings.apply("unmute", now));
  ASSERT_TRUE(settings.apply("push-to-talk", now));
  EXPECT_FALSE(settings.sends(now));
  ASSERT_TRUE(settings.apply("talk", now));
  EXPECT_TRUE(settings.sends(now + Duration::ms(100)));
  EXPECT_FALSE(settings.sends(now + Duration::s(1)));
  ASSERT_TRUE(settings.apply("stop-talking", now + Duration::ms(50)));
  EXPECT_FALSE(settings.sends(now + Duration::ms(100))) << "the key was let go";
  ASSERT_TRUE(settings.apply("open", now));
  ASSERT_TRUE(settings.apply("deafen", now));
  EXPECT_FALSE(settings.sends(now)) << "who does not hear is not heard either";
  ASSERT_TRUE(settings.apply("with-picture", now));
  EXPECT_TRUE(settings.follows_picture);
  ASSERT_TRUE(settings.apply("volume bob=0.25", now));
  EXPECT_EQ(settings.volume_of(*GuestId::parse("bob")), 0.25f);
  EXPECT_EQ(settings.volume_of(*GuestId::parse("eve")), 1.0f);
  for (const char* wrong :
       {"", "Mute", "volume", "volume ", "volume bob", "volume bob=3", "volume BOB=1",
        "volume bob=-1", "volume bob=nan", "volume bob=0.5x", "talk now"})
    EXPECT_FALSE(settings.apply(wrong, now)) << wrong;
  EXPECT_FALSE(settings.hearing().hears(*GuestId::parse("bob"))) << "deafened";
  ASSERT_TRUE(settings.apply("undeafen", now));
  EXPECT_TRUE(settings.hearing().hears(*GuestId::parse("bob")));
  ASSERT_TRUE(settings.apply("volume bob=0", now));
  EXPECT_FALSE(settings.hearing().hears(*GuestId::parse("bob"))) << "takes no bytes";
  EXPECT_TRUE(settings.hearing().hears(*GuestId::parse("eve")));
  for (int i = 0; i < 100; ++i)
    static_cast<void>(settings.set_volume("g" + std::to_string(i) + "=1"));
  EXPECT_FALSE(settings.set_volume("another=1"));
}

TEST(StagePlaces, AFullRoomHasItsPlacesAndWhoLeftMakesRoom) {
  StagePlaces places;
  const auto dancer = [](std::size_t i) { return *GuestId::parse("g" + std::to_string(i)); };
  const auto me = dancer(0);
  Pose pose;
  // Twice as many as fit, half of whom leave.
  for (std::size_t i = 0; i < 2 * StagePlaces::kMostDancers; ++i) {
    pose.p_WH_m = {static_cast<float>(i), 1.0f, 0.0f};
    places.see(dancer(i), pose);
    pose.p_WH_m = {0.0f, 1.0f, 0.0f};
    places.see(me, pose);
  }
  std::size_t placed = 0;
  for (std::size_t i = 1; i < 2 * StagePlaces::kMostDancers; ++i)
    if (const auto place = places.place_of(dancer(i), me)) {
      ++placed;
      EXPECT_GT(i, StagePlaces::kMostDancers) << "the last that came";
      EXPECT_EQ(place->distance_m, static_cast<float>(i));
    }
  EXPECT_EQ(placed, 127u);
}

std::unique_ptr<OwnVoice> own_voice() {
  VoiceCleanerOptions cleaning;
  cleaning.takes_out_noise = false;
  cleaning.levels_loudness = false;
  auto made = OwnVoice::create(cleaning, {}, 7);
  EXPECT_TRUE(made) << made.error().what;
  return std::move(*made);
}

TEST(OwnVoice, SaysItsLevelAndFallsSilentWhenItIsMuted) {
  auto own = own_voice();
  auto sound = hummed(6.0, false);
  int open = 0, muted = 0;
  std::uint32_t last = 0;
  for (std::size_t i = 0; i < 600; ++i) {
    const auto frame = std::span(sound).subspan(i * kVoiceFrameSamples).first<kVoiceFrameSamples>();
    const auto voice = own->take(frame, MonoTime::from_us(1), Duration(), i < 300);
    if (!voice) continue;
    ++(i < 300 ? open : muted);
    EXPECT_TRUE(is_valid(*voice));
    EXPECT_EQ(voice->clock_id, 7u);
    last = voice->sequence;
    if (i > 50 && i < 300) {
      EXPECT_GT(voice->level_dbfs, -60);
    }
    if (i >= 300) {
      EXPECT_EQ(voice->level_dbfs, kSilence_dbfs);
    }
    EXPECT_GT(own->level(), -70) << "the own meter shows what the microphone hears";
  }
  EXPECT_GT(open, 290);
  EXPECT_LT(muted, 50);
  EXPECT_GE(last, 500u) << "what is left out is counted";
}

TEST(OwnVoice, KnowsItsPacketsFromThoseOfARecordingOfItsGuest) {
  auto own = own_voice();
  auto sound = hummed(6.0, false);
  std::vector<Voice> made;
  for (std::size_t i = 0; i < 600; ++i) {
    const auto frame = std::span(sound).subspan(i * kVoiceFrameSamples).first<kVoiceFrameSamples>();
    const auto captured = kVoiceBegin + Duration::ms(10 * static_cast<std::int64_t>(i));
    if (const auto voice = own->take(frame, captured, Duration(), true)) made.push_back(*voice);
  }
  ASSERT_GT(made.size(), 500u);
  for (std::size_t i = made.size() - 500; i < made.size(); ++i) {
    EXPECT_TRUE(own->has_made(made[i])) << i;
    // As LogPlayer stamps it: of this house's clock, at another time.
    Voice replayed = made[i];
    replayed.capture_time = replayed.capture_time + Duration::us(2'345'678);
    EXPECT_FALSE(own->has_made(replayed)) << i;
    replayed = made[i];
    replayed.clock_id = 8;
    EXPECT_FALSE(own->has_made(replayed)) << i;
  }
}

TEST(ReplayedVoices, WhoSaysThatItsProgramRunsIsNoRecording) {
  ReplayedVoices voices;
  const auto amy = *GuestId::parse("amy"), bob = *GuestId::parse("bob");
  const MonoTime begin = kVoiceBegin;
  EXPECT_FALSE(voices.is_replayed(bob, begin, begin + Duration::s(1))) << "not known yet";
  voices.see_live(amy, begin + Duration::ms(900));
  MonoTime now = begin + Duration::s(3);
  EXPECT_TRUE(voices.is_replayed(bob, begin, now));
  EXPECT_FALSE(voices.is_replayed(amy, begin, now));
  voices.see_live(amy, now);
  now = now + Duration::ms(2900);
  EXPECT_FALSE(voices.is_replayed(amy, begin, now)) << "two of three states lost";
  EXPECT_TRUE(voices.is_replayed(amy, begin, now + Duration::s(1))) << "it has ended";
  // More than are remembered: the one seen the longest ago makes room.
  for (std::size_t i = 0; i < ReplayedVoices::kMostGuests; ++i)
    voices.see_live(*GuestId::parse("g" + std::to_string(i)),
                    now + Duration::us(static_cast<std::int64_t>(i)));
  EXPECT_FALSE(voices.is_replayed(*GuestId::parse("g0"), begin, now));
  voices.see_live(amy, now + Duration::ms(1));
  EXPECT_TRUE(voices.is_replayed(*GuestId::parse("g0"), begin, now));
  EXPECT_FALSE(voices.is_replayed(*GuestId::parse("g1"), begin, now));
}

TEST(RoomVoices, EachIsHeardOnItsSideAndOneMoreThanFitIsHeardToo) {
  auto made = RoomVoices::create();
  ASSERT_TRUE(made);
  RoomVoices& voices = **made;
  const auto me = *GuestId::parse("me"), bob = *GuestId::parse("bob");
  Pose pose;
  pose.p_WH_m = {0.0f, 1.0f, 0.0f};
  voices.see(me, pose);
  pose.p_WH_m = {3.0f, 1.0f, 0.0f};
  voices.see(bob, pose);
  const auto sent = encode_voice(hummed(3.0, false), {});
  ASSERT_TRUE(sent);
  MonoTime now = kVoiceBegin;
  // Many guests who say little, and then bob.
  for (int i = 0; i < 40; ++i, now += kVoiceFrame)
    voices.hear(*GuestId::parse("g" + std::to_string(i)), sent->packets[0], now);
  VoiceSettings settings;
  double left = 0.0, right = 0.0, quiet = 0.0;
  for (std::size_t i = 0; i < 280; ++i, now += kVoiceFrame) {
    Voice voice = sent->packets[i];
    voice.capture_time = now - Duration::ms(20);
    voices.hear(bob, voice, now);
    std::array<float, 2 * kVoiceFrameSamples> stereo{};
    if (i == 140) {
      ASSERT_TRUE(settings.set_volume("bob=0"));
    }
    voices.mix(stereo, now, now, me, settings);
    for (std::size_t k = 0; k < kVoiceFrameSamples; ++k) {
      const double l = static_cast<double>(stereo[2 * k]),
                   r = static_cast<double>(stereo[2 * k + 1]);
      if (i > 60 && i < 140) {
        left += l * l;
        right += r * r;
      }
      if (i > 200) quiet += l * l + r * r;
    }
  }
  EXPECT_GT(left, 2.0 * right);
  EXPECT_GT(left, 0.01);
  EXPECT_LT(quiet, 0.001 * left);
  std::size_t guests = 0;
  voices.each([&](const RoomVoices::Guest&) { ++guests; });
  EXPECT_EQ(guests, RoomVoices::kMostVoices);
}

TEST(RoomVoices, FollowsThePictureWhereItIsToldTo) {
  auto made = RoomVoices::create();
  ASSERT_TRUE(made);
  RoomVoices& voices = **made;
  const auto me = *GuestId::parse("me"), bob = *GuestId::parse("bob");
  const auto sent = encode_voice(hummed(6.0, false), {});
  ASSERT_TRUE(sent);
  VoiceSettings settings;
  settings.follows_picture = true;
  Playout playout;
  playout.delay_ms = 400.0f;
  MonoTime now = kVoiceBegin;
  std::optional<Duration> delay;
  for (std::size_t i = 0; i < 500; ++i, now += kVoiceFrame) {
    Voice voice = sent->packets[i];
    voice.capture_time = now - Duration::ms(20);
    voices.hear(bob, voice, now);
    if (i == 0) voices.know_picture(bob, playout);
    std::array<float, 2 * kVoiceFrameSamples> stereo{};
    voices.mix(stereo, now, now + Duration::ms(25), me, settings);
    voices.each([&](const RoomVoices::Guest& guest) { delay = guest.playout->delay(); });
  }
  ASSERT_TRUE(delay);
  EXPECT_NEAR(delay->as_ms(), 400.0, 15.0);
}

}  // namespace
}  // namespace dance
