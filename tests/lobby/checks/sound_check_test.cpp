// Microphone and loudspeaker with a real sound server: null sinks as rooms.
#include "lobby/checks/sound_check.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/net/mono_clock.h"
#include "testing/voice/sound_rooms.h"
#include "tests/apps/run_program.h"

namespace dance {
namespace {

std::vector<float> speech_tone(float amplitude, double seconds) {
  std::vector<float> samples(static_cast<std::size_t>(seconds * 48'000.0));
  for (std::size_t i = 0; i < samples.size(); ++i)
    samples[i] = amplitude * static_cast<float>(std::sin(2.0 * std::numbers::pi * 440.0 *
                                                         static_cast<double>(i) / 48'000.0));
  return samples;
}

class SoundCheckTest : public testing::Test {
 protected:
  void SetUp() override {
    if (!SoundRooms::is_there()) GTEST_SKIP() << "no pulseaudio: apt-get install pulseaudio";
  }
  void open_rooms(const std::vector<SoundRooms::Leak>& leaks = {}) {
    auto opened = SoundRooms::open(folder_.path("."), {"speaker", "mouth"}, leaks);
    ASSERT_TRUE(opened) << opened.error().what;
    rooms_ = std::move(*opened);
  }
  void start(const SoundChoice& choice = {"mouth.monitor", "speaker"}) {
    check_ = SoundCheck::start(choice);
  }
  void work() {
    if (rooms_) rooms_->work(mono_now());
    check_->read(mono_now());
  }
  template <class Condition>
  bool comes_to(const Condition& condition) {
    return wait_for([&] {
      // More often than wait_for() looks: the rooms' streams are to be fed.
      for (int i = 0; i < 8; ++i) {
        work();
        if (condition()) return true;
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
      }
      return false;
    });
  }
  bool is_told(Text text) const {
    return std::find(check_->advice().begin(), check_->advice().end(), text) !=
           check_->advice().end();
  }
  std::string told() const { return Texts(Language::kEnglish)[check_->advice().front()]; }

  TestFolder folder_{"sound-check"};
  std::unique_ptr<SoundRooms> rooms_;
  std::unique_ptr<SoundCheck> check_;
};

TEST_F(SoundCheckTest, HearsHowLoudOneSpeaks) {
  open_rooms();
  start();
  ASSERT_TRUE(rooms_->play("mouth", speech_tone(0.1f, 30.0)));
  EXPECT_TRUE(comes_to([&] { return std::abs(check_->level().rms_db + 23.0f) < 1.0f; }))
      << check_->level().rms_db << " " << told();
  EXPECT_NEAR(check_->level().held_db, -20.0f, 1.0f);
  EXPECT_TRUE(comes_to([&] { return check_->is_good(); })) << told();
}

TEST_F(SoundCheckTest, TellsOfSilence) {
  open_rooms();
  start();
  EXPECT_TRUE(comes_to([&] { return is_told(Text::kSoundSilent); })) << told();
}

TEST_F(SoundCheckTest, TellsOfAMicrophoneThatIsMuted) {
  open_rooms();
  start();
  ASSERT_EQ(run("pactl set-source-mute mouth.monitor 1").exit_code, 0);
  EXPECT_TRUE(comes_to([&] { return is_told(Text::kSoundMicrophoneMuted); })) << told();
  ASSERT_EQ(run("pactl set-source-mute mouth.monitor 0").exit_code, 0);
  EXPECT_TRUE(comes_to([&] { return !is_told(Text::kSoundMicrophoneMuted); })) << told();
}

TEST_F(SoundCheckTest, ListsDevicesByTheNamesThatASessionFileHolds) {
  open_rooms();
  start();
  ASSERT_TRUE(comes_to([&] { return !check_->loudspeakers().empty(); }));
  const auto has = [](std::span<const ListedSound> list, const std::string& name) {
    return std::any_of(list.begin(), list.end(), [&](const ListedSound& d) {
      return d.name == name && !d.description.empty();
    });
  };
  EXPECT_TRUE(has(check_->loudspeakers(), "speaker"));
  EXPECT_TRUE(has(check_->loudspeakers(), "mouth"));
  EXPECT_TRUE(has(check_->microphones(), "mouth.monitor"));
}

TEST_F(SoundCheckTest, ADeviceThatIsNotThereIsToldAndAnotherCanBeChosen) {
  open_rooms();
  start({"alsa_input.gone", "alsa_output.gone"});
  ASSERT_TRUE(comes_to([&] { return is_told(Text::kSoundMicrophoneGone); })) << told();
  EXPECT_TRUE(is_told(Text::kSoundLoudspeakerGone));
  ASSERT_TRUE(rooms_->play("mouth", speech_tone(0.1f, 30.0)));
  check_->choose({"mouth.monitor", "speaker"});
  EXPECT_TRUE(comes_to([&] { return check_->is_good(); })) << told();
}

TEST_F(SoundCheckTest, PlaysFiveSixSevenEightOnTheChosenLoudspeaker) {
  open_rooms();
  const auto ear = rooms_->listen("speaker");
  ASSERT_TRUE(ear) << ear.error().what;
  start();
  ASSERT_TRUE(comes_to([&] { return !check_->loudspeakers().empty(); }));
  const MonoTime begin = mono_now();
  check_->play_count_in();
  ASSERT_TRUE(comes_to([&] { return check_->is_playing(); }));
  ASSERT_TRUE(comes_to([&] { return !check_->is_playing(); }));
  const auto heard = rooms_->heard(*ear, begin, Duration::s(8));
  int tones = 0;
  std::size_t last_loud = 0;
  for (std::size_t i = 0; i < heard.size(); ++i) {
    if (std::abs(heard[i]) < 0.1f) continue;
    if (tones == 0 || i - last_loud > 4800) ++tones;
    last_loud = i;
  }
  EXPECT_EQ(tones, 4);
}

TEST_F(SoundCheckTest, MeasuresTheWayThereAndBack) {
  open_rooms({{"speaker", "mouth"}});
  start();
  // The level is known: the microphone works.
  ASSERT_TRUE(comes_to([&] { return check_->level().windows > 2; })) << told();
  // A loaded machine's sound has gaps: then it is measured again.
  for (int i = 0; i == 0 || (i < 5 && !check_->round_trip()->is_heard); ++i) {
    check_->measure_round_trip();
    ASSERT_TRUE(comes_to([&] { return check_->round_trip().has_value(); })) << told();
  }
  EXPECT_TRUE(check_->round_trip()->is_heard) << check_->round_trip()->likeness;
  EXPECT_GT(check_->round_trip()->delay, Duration::ms(30)) << "what the room takes alone";
  EXPECT_LT(check_->round_trip()->delay, Duration::s(1));
  EXPECT_TRUE(is_told(Text::kSoundEchoHeard)) << told();
}

TEST_F(SoundCheckTest, HeadphonesGiveNoEcho) {
  open_rooms();
  start();
  ASSERT_TRUE(comes_to([&] { return check_->level().windows > 2; })) << told();
  check_->measure_round_trip();
  ASSERT_TRUE(comes_to([&] { return check_->round_trip().has_value(); })) << told();
  EXPECT_FALSE(check_->round_trip()->is_heard);
  EXPECT_FALSE(is_told(Text::kSoundEchoHeard));
}

TEST_F(SoundCheckTest, WithoutASoundServerThereIsOneText) {
  // NOLINTBEGIN(concurrency-mt-unsafe): no thread of the test reads it meanwhile
  ::setenv("PULSE_SERVER", ("unix:" + folder_.path("native")).c_str(), 1);
  start({"", ""});
  EXPECT_TRUE(comes_to([&] { return is_told(Text::kSoundNoServer); })) << told();
  EXPECT_EQ(check_->advice().size(), 1u);
  check_.reset();
  ::unsetenv("PULSE_SERVER");
  // NOLINTEND(concurrency-mt-unsafe)
}

}  // namespace
}  // namespace dance
