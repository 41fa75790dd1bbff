// A music that fits two levels, heard by the microphones of three houses: in one a dancer steps at
// half of the tempo that the tracker finds, in one nobody dances, in one somebody dances at a tempo
// that is none of its levels. The real programs, with a sound server between them.
#include <memory>

#include "producers/salsa/salsa_dancer.h"
#include "tests/apps/music/music_programs.h"
#include "tests/apps/sound_server.h"
#include "tests/producers/music/drum_music.h"

namespace dance {
namespace {

constexpr const char* kLoudspeakerBus = "udpm://239.255.76.67:7744?ttl=0";
constexpr const char* kThirdBus = "udpm://239.255.76.67:7745?ttl=0";
constexpr double kHeard_bpm = 184.0;
constexpr double kStepped_bpm = 92.0;
constexpr double kAnother_bpm = 130.0;
constexpr double kCamera_hz = 60.0;

// A house with a manager and a microphone, and who dances in it before a camera.
class ListeningHouse {
 public:
  ListeningHouse(const char* url, double steps_bpm) : ear_(url) {
    auto bus = Bus::open(url);
    EXPECT_TRUE(bus) << bus.error().what;
    camera_ = std::move(*bus);
    camera_->subscribe<Steps>(
        Where::kLocal, [this](const Channel&, const Steps& steps, MonoTime) { told_ = steps; });
    if (steps_bpm <= 0.0) return;
    SalsaStyle style;
    style.tempo_bpm = steps_bpm;
    style.seed = 5;
    dancer_ = std::make_unique<SalsaDancer>(style);
  }

  void work() {
    const MonoTime now = mono_now();
    ear_.work();
    camera_->drain(now);
    for (; dancer_ && begin_ + Duration::seconds(seen_ / kCamera_hz) <= now; ++seen_) {
      Pose pose;
      const Duration t = Duration::seconds(seen_ / kCamera_hz);
      dancer_->dance_at(t, pose);
      pose.sequence = static_cast<std::uint32_t>(seen_);
      pose.capture_time = begin_ + t;
      pose.clock_id = this_clock_id();
      pose.music_beats = kNoMusic;
      camera_->publish(Where::kCapture, *GuestId::parse("alice"), pose);
    }
  }
  // The mean tempo of what was said lately; 0 before there is enough.
  double tempo_bpm() const {
    constexpr std::size_t kLately = 30;
    if (ear_.playing() < kLately) return 0.0;
    double sum = 0.0;
    for (std::size_t i = ear_.said().size() - kLately; i < ear_.said().size(); ++i)
      sum += ear_.said()[i].tempo_bpm / static_cast<double>(kLately);
    return sum;
  }
  const std::optional<Steps>& told() const { return told_; }
  const BeatEar& ear() const { return ear_; }

 private:
  BeatEar ear_;
  std::unique_ptr<Bus> camera_;
  std::unique_ptr<SalsaDancer> dancer_;
  MonoTime begin_ = mono_now();
  int seen_ = 0;
  std::optional<Steps> told_;
};

class MusicSteps : public MusicPrograms {
 protected:
  void open_listening_house(const char* bus, const char* name) {
    std::ofstream(folder_.path(std::string(name) + ".toml"))
        << "[house]\nbus = \"" << bus << "\"\nguests = [\"alice\"]\n"
        << "[[route]]\nfrom = \"POSE/capture/*\"\nto = \"POSE/stage/*\"\n";
    start("dance-manager", {folder_.path(std::string(name) + ".toml")});
    start("dance-music", {"--microphone", "--source", "dance.monitor", "--bus", bus});
  }
};

TEST_F(MusicSteps, OfADancerChooseTheLevelOfWhatAMicrophoneHears) {
  if (!SoundServer::is_there()) GTEST_SKIP() << "no pulseaudio: apt-get install pulseaudio";
  SoundServer sound(folder_);
  ASSERT_TRUE(sound.is_open()) << text_of(folder_.path("pulse/talk"));
  constexpr double kSong_s = 300.0;
  const auto beats_s = DrumMusic::steady(kSong_s, kHeard_bpm);
  const std::string song = make_song("song", beats_s, 4);
  write_wav(song, DrumMusic(kRate_hz).play(beats_s, kSong_s), 1, kRate_hz);
  open_listening_house(kBus, "stepping");
  open_listening_house(kOtherBus, "silent");
  open_listening_house(kThirdBus, "another");
  start("dance-music", {song, "--bus", kLoudspeakerBus});
  ListeningHouse stepping(kBus, kStepped_bpm), silent(kOtherBus, 0.0),
      another(kThirdBus, kAnother_bpm);
  const auto work = [&] {
    stepping.work();
    silent.work();
    another.work();
  };
  const auto is_near = [](double a, double b) { return std::abs(a / b - 1.0) < 0.04; };
  ASSERT_TRUE(wait_for(
      [&] {
        work();
        return stepping.told() && is_near(stepping.tempo_bpm(), kStepped_bpm) &&
               is_near(silent.tempo_bpm(), kHeard_bpm) && is_near(another.tempo_bpm(), kHeard_bpm);
      },
      std::chrono::seconds(120)))
      << stepping.tempo_bpm() << " BPM; " << talk();
  ASSERT_TRUE(stepping.told());
  EXPECT_NEAR(stepping.told()->tempo_bpm, kStepped_bpm, 4.0);
  EXPECT_EQ(stepping.told()->dancers, 1);
  EXPECT_FALSE(silent.told()) << "nobody dances there";
  // It stays so.
  const std::size_t until = stepping.ear().playing() + 100;
  ASSERT_TRUE(wait_for([&] {
    work();
    return stepping.ear().playing() >= until;
  })) << talk();
  EXPECT_NEAR(stepping.tempo_bpm(), kStepped_bpm, 3.0);
  EXPECT_NEAR(silent.tempo_bpm(), kHeard_bpm, 6.0);
  EXPECT_NEAR(another.tempo_bpm(), kHeard_bpm, 6.0);
  std::printf(
      "%.1f BPM where a dancer steps at %.0f, %.1f where nobody does, %.1f beside one at %.0f\n",
      stepping.tempo_bpm(), kStepped_bpm, silent.tempo_bpm(), another.tempo_bpm(), kAnother_bpm);
}

}  // namespace
}  // namespace dance
