// dance voice in two houses, with a sound server, a server between them and espeak-ng: who speaks
// is heard in the other house, and who is muted is not.
#include "testing/voice/sound_match.h"
#include "testing/voice/sound_rooms.h"
#include "testing/voice/speech.h"
#include "tests/apps/bus_programs.h"

namespace dance {
namespace {

constexpr const char* kServerPort = "7469";

class VoicePrograms : public BusPrograms {
 protected:
  void SetUp() override {
    if (!SoundRooms::is_there()) GTEST_SKIP() << "no pulseaudio: apt-get install pulseaudio";
    if (!has_speech_maker()) GTEST_SKIP() << "no espeak-ng: apt-get install espeak-ng";
  }
  void open_rooms() {
    const std::string home = folder_.path("sound");
    std::filesystem::create_directories(home);
    std::filesystem::permissions(home, std::filesystem::perms::owner_all);
    auto rooms = SoundRooms::open(home, {"mouth-a", "ear-a", "mouth-b", "ear-b"});
    ASSERT_TRUE(rooms) << rooms.error().what;
    rooms_ = std::move(*rooms);
  }
  // A house as its user starts it: one line of the session file turns voices on.
  void open_house_of(const std::string& guest, const char* bus, const std::string& side) {
    std::ofstream(folder_.path(guest + ".toml"))
        << "[house]\nguest = \"" << guest << "\"\nserver = \"127.0.0.1:" << kServerPort
        << "\"\nbus = \"" << bus << "\"\n[voice]\nmicrophone = \"mouth-" << side
        << ".monitor\"\nloudspeaker = \"ear-" << side << "\"\n";
    start("dance-join", {folder_.path(guest + ".toml"), "--no-view"});
  }
  template <class IsDone>
  bool work_until(IsDone is_done, std::chrono::seconds timeout = kTimeout) {
    const MonoTime end = mono_now() + Duration::s(timeout.count());
    while (!is_done()) {
      if (mono_now() >= end) return false;
      rooms_->work(mono_now());
      if (ear_) ear_->drain(mono_now());
      std::this_thread::sleep_for(std::chrono::milliseconds(3));
    }
    return true;
  }
  std::unique_ptr<SoundRooms> rooms_;
  std::unique_ptr<Bus> ear_;
};

TEST_F(VoicePrograms, WhoSpeaksIsHeardInTheOtherHouse) {
  open_rooms();
  start("dance-server", {"--port", kServerPort});
  open_house_of("alice", kBus, "a");
  open_house_of("bob", kOtherBus, "b");
  auto bus = Bus::open(kOtherBus);
  ASSERT_TRUE(bus) << bus.error().what;
  ear_ = std::move(*bus);
  int heard = 0, loud = 0;
  ear_->subscribe<Voice>(Where::kGuest, [&](const Channel& channel, const Voice& voice, MonoTime) {
    if (channel.guest().view() != "alice") return;
    ++heard;
    loud += voice.level_dbfs > -50 ? 1 : 0;
  });
  const auto talk = [&] { return text_of(folder_.path("talk")); };
  const auto mouth = rooms_->listen("mouth-a"), ear = rooms_->listen("ear-b");
  ASSERT_TRUE(mouth && ear);
  const auto speech = make_speech(15.0, 0, folder_.path("speech.wav"));
  ASSERT_TRUE(speech) << speech.error().what;
  const MonoTime begin = mono_now();
  ASSERT_TRUE(rooms_->play("mouth-a", *speech));
  ASSERT_TRUE(work_until([&] { return loud > 300; })) << talk();
  // Of what was said something is heard, in order, somewhat later.
  const Duration length = mono_now() - begin;
  const auto matches = match_sound(rooms_->heard(*mouth, begin, length),
                                   rooms_->heard(*ear, begin, length), 0.0, 1500.0);
  const MatchFigures figures = figures_of(matches);
  std::printf("%zu of %zu pieces are heard, %.0f ms later (median)\n", figures.fitting,
              figures.pieces, figures.median_ms);
  EXPECT_GE(figures.fitting, 3u) << talk();
  // Muted from another terminal, nothing more comes but that there is silence.
  const Finished muted =
      run(bin("dance-voice-set") + " --guest alice --mute --bus " + quoted(kBus));
  EXPECT_EQ(muted.exit_code, 0) << muted.talk;
  ASSERT_TRUE(work_until([&] { return talk().find("alice is muted") != std::string::npos; }));
  const auto settle = mono_now() + Duration::ms(500);
  ASSERT_TRUE(work_until([&] { return mono_now() > settle; }));
  const int loud_before = loud;
  const MonoTime quiet_end = mono_now() + Duration::s(1);
  ASSERT_TRUE(work_until([&] { return mono_now() > quiet_end; }));
  EXPECT_EQ(loud, loud_before);
  EXPECT_EQ(run(bin("dance-voice-set") + " --guest eve --mute --bus " + quoted(kBus)).exit_code, 1);
}

TEST_F(VoicePrograms, WithoutASoundServerThereIsOneLineAndTheHouseGoesOn) {
  ::setenv("PULSE_SERVER", "unix:/nowhere", 1);  // NOLINT(concurrency-mt-unsafe): one thread
  const Finished alone = run(bin("dance-voice") + " --guest alice --bus " + quoted(kBus));
  EXPECT_EQ(alone.exit_code, 1);
  EXPECT_NE(alone.talk.find("no sound server"), std::string::npos) << alone.talk;
  EXPECT_EQ(std::count(alone.talk.begin(), alone.talk.end(), '\n'), 1) << alone.talk;
  std::ofstream(folder_.path("house.toml"))
      << "[house]\nguest = \"alice\"\nbus = \"" << kBus << "\"\n[voice]\n"
      << "[[produce]]\nkind = \"salsa\"\nguest = \"alice\"\n";
  start("dance-join", {folder_.path("house.toml"), "--no-view"});
  auto bus = Bus::open(kBus);
  ASSERT_TRUE(bus) << bus.error().what;
  int poses = 0;
  (*bus)->subscribe<Pose>(Where::kStage, [&](const Channel&, const Pose&, MonoTime) { ++poses; });
  const auto talk = [&] { return text_of(folder_.path("talk")); };
  EXPECT_TRUE(wait_for([&] {
    (*bus)->drain(mono_now());
    return poses > 30 && talk().find("the house goes on") != std::string::npos;
  })) << talk();
  ::unsetenv("PULSE_SERVER");  // NOLINT(concurrency-mt-unsafe): one thread
}

}  // namespace
}  // namespace dance
