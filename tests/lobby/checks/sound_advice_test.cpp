#include "lobby/checks/sound_advice.h"

#include <gtest/gtest.h>

#include <vector>

#include "lobby/checks/sound_check.h"

namespace dance {
namespace {

using SoundServer = SoundState::Server;
using enum DeviceState;

SoundLevel spoken() {
  SoundLevel level;
  level.rms_db = -25.0f;
  level.is_heard = true;
  return level;
}

std::vector<Text> told(const SoundState& state, const SoundLevel& level, bool has_echo = false) {
  const SoundAdvice advice = advise(state, level, has_echo);
  return {advice.view().begin(), advice.view().end()};
}

TEST(SoundAdvice, AVoiceThatIsHeardIsGood) {
  EXPECT_EQ(told({SoundServer::kHere, kWorks, kWorks}, spoken()), std::vector{Text::kSoundGood});
  EXPECT_EQ(told({SoundServer::kHere, kWorks, kWorks}, {}), std::vector{Text::kSoundSaySomething});
}

TEST(SoundAdvice, WithoutAServerThereIsOneText) {
  EXPECT_EQ(told({SoundServer::kNotBuilt, kGone, kGone}, {}), std::vector{Text::kSoundNotBuilt});
  EXPECT_EQ(told({SoundServer::kNone, kGone, kGone}, {}), std::vector{Text::kSoundNoServer});
  EXPECT_EQ(told({SoundServer::kConnecting, kOpening, kOpening}, {}),
            std::vector{Text::kSoundOpening});
}

TEST(SoundAdvice, EachTroubleOfADeviceHasItsText) {
  SoundLevel silent;
  silent.is_silent = true;
  EXPECT_EQ(told({SoundServer::kHere, kWorks, kWorks}, silent), std::vector{Text::kSoundSilent});
  EXPECT_EQ(told({SoundServer::kHere, kMuted, kWorks}, silent),
            std::vector{Text::kSoundMicrophoneMuted})
      << "what is known to be muted is not guessed at";
  EXPECT_EQ(told({SoundServer::kHere, kGone, kWorks}, {}), std::vector{Text::kSoundMicrophoneGone});
  EXPECT_EQ(told({SoundServer::kHere, kNone, kWorks}, {}), std::vector{Text::kSoundMicrophoneNone});
  EXPECT_EQ(told({SoundServer::kHere, kWorks, kMuted}, spoken()),
            std::vector{Text::kSoundLoudspeakerMuted});
  EXPECT_EQ(told({SoundServer::kHere, kWorks, kGone}, spoken()),
            std::vector{Text::kSoundLoudspeakerGone});
  EXPECT_EQ(told({SoundServer::kHere, kWorks, kNone}, spoken()),
            std::vector{Text::kSoundLoudspeakerNowhere});
  SoundLevel loud = spoken();
  loud.clips = true;
  EXPECT_EQ(told({SoundServer::kHere, kWorks, kWorks}, loud), std::vector{Text::kSoundClips});
}

TEST(SoundAdvice, AnEchoIsToldBesideTheRest) {
  EXPECT_EQ(told({SoundServer::kHere, kWorks, kMuted}, spoken(), true),
            (std::vector{Text::kSoundLoudspeakerMuted, Text::kSoundEchoHeard}));
}

TEST(SoundAdvice, TheWayThereAndBackIsSaidWithItsTime) {
  RoundTrip trip;
  trip.is_heard = true;
  trip.delay = Duration::us(84'600);
  EXPECT_EQ(say_round_trip(Texts(Language::kEnglish), trip),
            "Loudspeaker and microphone: 84 ms there and back");
  trip.is_heard = false;
  EXPECT_EQ(say_round_trip(Texts(Language::kGerman), trip),
            Texts(Language::kGerman)[Text::kSoundNoEcho]);
}

}  // namespace
}  // namespace dance
