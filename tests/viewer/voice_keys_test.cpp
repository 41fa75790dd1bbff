#include "viewer/window/voice_keys.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace dance {
namespace {

constexpr MonoTime kKeysBegin = MonoTime::from_us(1'000'000);

GuestId named(const char* name) { return *GuestId::parse(name); }

class VoiceKeysTest : public ::testing::Test {
 protected:
  void add(const char* guest, bool is_push_to_talk) {
    SceneVoice voice;
    voice.guest = named(guest);
    voice.is_push_to_talk = is_push_to_talk;
    scene_.voices.push_back(voice);
  }
  void work() { keys_.work(scene_, chosen_, wishes_, now_); }

  SceneState scene_;
  std::optional<GuestId> chosen_;
  VoiceWishes wishes_;
  MonoTime now_ = kKeysBegin;
  bool is_there_ = true;
  std::vector<std::string> told_;
  VoiceKeys keys_{[this](const GuestId& guest, std::string_view command) -> Result<void> {
                    if (!is_there_)
                      return fail("no dance voice runs for " + std::string(guest.view()));
                    told_.push_back(std::string(guest.view()) + " " + std::string(command));
                    return {};
                  },
                  Language::kEnglish};
};

TEST_F(VoiceKeysTest, TalkWhileTheKeyIsHeldAndNoLonger) {
  add("alice", true);
  wishes_.is_talk_held = true;
  for (int picture = 0; picture < 60; ++picture, now_ += Duration::ms(16)) work();
  ASSERT_GE(told_.size(), 4u) << "often enough for a dance voice to go on";
  EXPECT_LE(told_.size(), 6u) << "and not at each picture";
  for (const std::string& words : told_) EXPECT_EQ(words, "alice talk");
  told_.clear();
  wishes_.is_talk_held = false;
  for (int picture = 0; picture < 60; ++picture, now_ += Duration::ms(16)) work();
  EXPECT_EQ(told_, std::vector<std::string>{"alice stop-talking"}) << "once";
  EXPECT_EQ(keys_.words(now_), "");
}

TEST_F(VoiceKeysTest, WhoWasToldToTalkIsToldToStopWhoeverIsChosenMeanwhile) {
  add("alice", true);
  add("amy", true);
  chosen_ = named("amy");
  wishes_.is_talk_held = true;
  work();
  chosen_ = named("alice");
  now_ += Duration::ms(300);
  work();
  scene_.voices.clear();
  wishes_.is_talk_held = false;
  work();
  EXPECT_EQ(told_, (std::vector<std::string>{"amy talk", "amy talk", "amy stop-talking"}));
}

TEST_F(VoiceKeysTest, MuteAndDeafenTheChosenOrTheFirstAndBack) {
  add("alice", false);
  add("amy", false);
  chosen_ = named("bob");  // of another house
  wishes_.mute_presses = 1;
  work();
  scene_.voices[0].is_muted = true;
  wishes_.mute_presses = 3;
  wishes_.deafen_presses = 2;
  work();
  chosen_ = named("amy");
  wishes_.deafen_presses = 1;
  work();
  scene_.voices[1].is_deafened = true;
  wishes_.deafen_presses = 1;
  work();
  work();
  EXPECT_EQ(told_,
            (std::vector<std::string>{"alice mute", "alice unmute", "amy deafen", "amy undeafen"}));
}

TEST_F(VoiceKeysTest, SayForAWhileWhatIsMissing) {
  wishes_.mute_presses = 1;
  work();
  EXPECT_EQ(keys_.words(now_), "You are not in the voice chat.");
  now_ += VoiceKeys::kWordsHold + Duration::ms(1);
  EXPECT_EQ(keys_.words(now_), "");
  add("alice", false);
  wishes_.is_talk_held = true;
  work();
  EXPECT_NE(keys_.words(now_).find("without pressing the key"), std::string::npos);
  scene_.voices[0].is_muted = true;
  work();
  EXPECT_NE(keys_.words(now_).find("muted"), std::string::npos);
  scene_.voices[0].has_microphone = scene_.voices[0].has_loudspeaker = false;
  work();
  EXPECT_NE(keys_.words(now_).find("microphone cannot be reached"), std::string::npos);
  scene_.voices[0].has_microphone = scene_.voices[0].has_loudspeaker = true;
  is_there_ = false;
  wishes_.mute_presses = 1;
  wishes_.is_talk_held = false;
  work();
  EXPECT_EQ(keys_.words(now_), "no dance voice runs for alice");
}

TEST(VoiceMark, OfSeveralTheOneThatMattersMostIsShown) {
  SceneVoice voice;
  EXPECT_EQ(mark_of(voice), VoiceMark::kNone);
  voice.is_push_to_talk = true;
  EXPECT_EQ(mark_of(voice), VoiceMark::kTalking);
  voice.is_heard = false;
  EXPECT_EQ(mark_of(voice), VoiceMark::kWaiting);
  voice.has_microphone = false;
  EXPECT_EQ(mark_of(voice), VoiceMark::kNoMicrophone);
  voice.is_muted = true;
  EXPECT_EQ(mark_of(voice), VoiceMark::kMuted);
  voice.is_deafened = true;
  EXPECT_EQ(mark_of(voice), VoiceMark::kDeafened);
}

}  // namespace
}  // namespace dance
