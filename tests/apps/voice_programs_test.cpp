// dance voice in two houses, with a sound server, a server between them and espeak-ng: who speaks
// is heard in the other house, and who is muted is not.
#include "tests/apps/voice_programs.h"

namespace dance {
namespace {

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
  // Of the pieces that were said before the end: the last ones had not come through yet.
  EXPECT_GE(2 * figures.fitting, figures.pieces) << talk();
  EXPECT_GT(figures.median_ms, 20.0) << "sooner than two sound buffers and a frame";
  EXPECT_LT(figures.median_ms, 400.0) << talk();
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
  // A second one for the same guest is told of the first.
  const Finished second = run(bin("dance-voice") + " --guest alice --bus " + quoted(kBus));
  EXPECT_EQ(second.exit_code, 1);
  EXPECT_NE(second.talk.find("alice has a dance voice on this bus already"), std::string::npos)
      << second.talk;
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
  EXPECT_TRUE(wait_for([&] {
    (*bus)->drain(mono_now());
    return poses > 30 && talk().find("the house goes on") != std::string::npos;
  })) << talk();
  ::unsetenv("PULSE_SERVER");  // NOLINT(concurrency-mt-unsafe): one thread
}

// The sound server comes after the house.
TEST_F(VoicePrograms, AHouseSaysAMissingSoundServerOnceAndThatVoicesWorkAgain) {
  // As open_rooms() has it, for the house that is there before.
  const std::string home = folder_.path("sound"), socket = "unix:" + home + "/native";
  std::filesystem::create_directories(home);
  std::filesystem::permissions(home, std::filesystem::perms::owner_all);
  // NOLINTBEGIN(concurrency-mt-unsafe): one thread
  ::setenv("PULSE_SERVER", socket.c_str(), 1);
  ::setenv("XDG_RUNTIME_DIR", home.c_str(), 1);
  // NOLINTEND(concurrency-mt-unsafe)
  std::ofstream(folder_.path("house.toml"))
      << "[house]\nguest = \"alice\"\nbus = \"" << kBus
      << "\"\n[voice]\npush_to_talk = true\nmicrophone = \"mouth-a.monitor\"\n"
      << "loudspeaker = \"ear-a\"\n";
  start("dance-join", {folder_.path("house.toml"), "--no-view"});
  const auto count = [&](const std::string& words) {
    const std::string text = talk();
    int found = 0;
    for (std::size_t at = 0; (at = text.find(words, at)) != std::string::npos; ++at) ++found;
    return found;
  };
  ASSERT_TRUE(wait_for([&] { return count("no sound server") == 1; })) << talk();
  // Another failed start is not said: the next one succeeds.
  const MonoTime later = mono_now() + Duration::s(13);
  wait_for([&] { return mono_now() > later; });
  EXPECT_EQ(count("no sound server"), 1) << talk();
  open_rooms();
  ASSERT_TRUE(work_until([&] { return count("voices are played at once") == 1; })) << talk();
  EXPECT_EQ(count("heard while B is held in dance view"), 1) << "no space bar here: " << talk();
  ASSERT_TRUE(work_until([&] { return count("dance voice works again") == 1; })) << talk();
  // What it says now is not kept back.
  EXPECT_EQ(run(bin("dance-voice-set") + " --guest alice --mute --bus " + quoted(kBus)).exit_code,
            0);
  EXPECT_TRUE(work_until([&] { return count("alice is muted") == 1; })) << talk();
  end_all();
  rooms_.reset();
  // NOLINTBEGIN(concurrency-mt-unsafe): one thread
  ::unsetenv("PULSE_SERVER");
  ::unsetenv("XDG_RUNTIME_DIR");
  // NOLINTEND(concurrency-mt-unsafe)
}

}  // namespace
}  // namespace dance
