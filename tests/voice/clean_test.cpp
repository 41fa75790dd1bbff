#include <gtest/gtest.h>

#include "testing/voice/room_echo.h"
#include "testing/voice/sound_match.h"
#include "testing/voice/speech.h"
#include "tests/test_folder.h"
#include "voice/clean/voice_cleaner.h"

namespace dance {
namespace {

constexpr std::size_t kCleanFrame = VoiceCleaner::kFrame;
constexpr std::size_t kLearns = 48'000 * 4;

std::vector<float> cleaned(const std::vector<float>& microphone,
                           const std::vector<float>& loudspeaker, bool takes_out_echo) {
  VoiceCleanerOptions options;
  options.takes_out_echo = takes_out_echo;
  options.takes_out_noise = false;
  options.levels_loudness = false;
  auto cleaner = VoiceCleaner::create(options);
  EXPECT_TRUE(cleaner) << cleaner.error().what;
  std::vector<float> sound = microphone;
  for (std::size_t at = 0; at + kCleanFrame <= sound.size(); at += kCleanFrame) {
    (*cleaner)->hear_loudspeaker(std::span(loudspeaker).subspan(at).first<kCleanFrame>());
    (*cleaner)->clean(std::span(sound).subspan(at).first<kCleanFrame>(), Duration::ms(40));
  }
  EXPECT_EQ((*cleaner)->refused(), 0u);
  return sound;
}

class VoiceClean : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!has_speech_maker()) GTEST_SKIP() << "no espeak-ng: apt-get install espeak-ng";
    far_ = *make_speech(9.0, 1, folder_.path("far.wav"));
    near_ = *make_speech(9.0, 0, folder_.path("near.wav"));
    echo_ = heard_in_room(far_, {});
  }
  static std::span<const float> tail(const std::vector<float>& sound) {
    return std::span(sound).subspan(kLearns, sound.size() - kLearns);
  }
  TestFolder folder_{"voice-clean"};
  std::vector<float> near_, far_, echo_;
};

TEST_F(VoiceClean, TheLoudspeakersEchoIsGone) {
  const double without_db = power_ratio_db(tail(echo_), tail(cleaned(echo_, far_, false)));
  const double with_db = power_ratio_db(tail(echo_), tail(cleaned(echo_, far_, true)));
  std::printf("echo quieter by %.1f dB, without cancellation by %.1f dB\n", with_db, without_db);
  EXPECT_LT(without_db, 3.0);
  EXPECT_GT(with_db, 25.0);
}

TEST_F(VoiceClean, TheOwnVoiceStaysWhileBothSpeak) {
  std::vector<float> both = echo_;
  for (std::size_t i = 0; i < both.size(); ++i) both[i] += near_[i];
  const auto sound = cleaned(both, far_, true);
  const MatchFigures own = figures_of(match_sound(tail(near_), tail(sound), 0.0, 30.0));
  EXPECT_GT(own.fitting * 10, own.pieces * 7) << "of " << own.pieces;
}

}  // namespace
}  // namespace dance
