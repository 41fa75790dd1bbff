// The recordings that come with the tree, played as their README says: both dancers and the beats
// of their music arrive, and a viewer draws them.
#include <gtest/gtest.h>

#include <map>

#include "tests/apps/bus_programs.h"
#include "tests/virtual_display.h"

namespace dance {
namespace {

const std::string kPlain = DANCE_SOURCE_DIR "/logs/couple.lcm";
const std::string kPacked = DANCE_SOURCE_DIR "/logs/couple-packed.lcm";

// Listens until poses of both dancers, with musical time in them, and beats have come.
void expect_couple_in_music(const char* url) {
  auto bus = Bus::open(url);
  ASSERT_TRUE(bus) << bus.error().what;
  std::map<std::string, int> poses;
  int beats = 0;
  (*bus)->subscribe<Pose>(Where::kCapture, [&](const Channel& channel, const Pose& pose, MonoTime) {
    if (pose.music_beats > 0.0) ++poses[std::string(channel.guest().view())];
  });
  (*bus)->subscribe<Beat>(Where::kLocal, [&](const Channel&, const Beat& beat, MonoTime) {
    EXPECT_NEAR(beat.tempo_bpm, 180.0, 0.5);
    ++beats;
  });
  constexpr int kDance = 100;
  EXPECT_TRUE(wait_for([&] {
    (*bus)->drain(mono_now());
    return poses["alice"] > kDance && poses["bob"] > kDance && beats > 10;
  })) << poses["alice"]
      << " poses of alice, " << poses["bob"] << " of bob, " << beats << " beats";
}

class ShippedLogPrograms : public BusPrograms {};

TEST_F(ShippedLogPrograms, ReplayPlaysBothForms) {
  start("dance-replay", {kPlain, "--bus", kBus});
  start("dance-replay", {kPacked, "--bus", kOtherBus});
  expect_couple_in_music(kBus);
  expect_couple_in_music(kOtherBus);
}

TEST_F(ShippedLogPrograms, LcmLogplayerPlaysThePlainForm) {
  if (run("command -v lcm-logplayer").exit_code != 0)
    GTEST_SKIP() << "lcm-logplayer is not installed";
  play_over_and_over(kPlain, kBus);
  expect_couple_in_music(kBus);
}

TEST_F(ShippedLogPrograms, ViewerDrawsThem) {
  if (!std::filesystem::exists(bin("dance-view"))) GTEST_SKIP() << "built without the viewer";
  for (const std::string& log : {kPlain, kPacked}) {
    const Finished view = run("ASAN_OPTIONS=detect_leaks=0 " + bin("dance-view") +
                              " --headless --quality low --size 160x90 --at 1,2 --log " + log +
                              " --focus ghost --out " + folder_.path("pictures"));
    if (view.talk.find("EGL") != std::string::npos) GTEST_SKIP() << view.talk;
    EXPECT_EQ(view.exit_code, 0) << view.talk;
    EXPECT_TRUE(std::filesystem::remove(folder_.path("pictures/stage-0002.png"))) << view.talk;
  }
}

TEST_F(ShippedLogPrograms, ViewerPlaysThemInAWindowOverAndOver) {
  if (!std::filesystem::exists(bin("dance-view"))) GTEST_SKIP() << "built without the viewer";
  const VirtualDisplay display(folder_.path());
  if (display.display().empty()) GTEST_SKIP() << kNoVirtualDisplay;
  setenv("DISPLAY", display.display().c_str(), 1);
  unsetenv("WAYLAND_DISPLAY");
  ChildProcess& view =
      start("dance-view", {"--log", kPlain, "--quality", "low", "--camera", "front", "--no-hud"});
  // Other pictures for longer than the recording, which is less than three seconds.
  const auto until = std::chrono::steady_clock::now() + std::chrono::seconds(5);
  std::set<std::string> late_pictures;
  ASSERT_TRUE(wait_for([&] {
    if (std::chrono::steady_clock::now() > until)
      late_pictures.insert(text_of(folder_.path("Xvfb_screen0")));
    return late_pictures.size() > 5 || view.has_ended();
  })) << text_of(folder_.path("talk"));
  EXPECT_FALSE(view.has_ended()) << text_of(folder_.path("talk"));
}

TEST_F(ShippedLogPrograms, GitTracksThemAndNoOtherRecording) {
  if (run("git -C " DANCE_SOURCE_DIR " rev-parse").exit_code != 0)
    GTEST_SKIP() << "the tree is no clone";
  const auto ignores = [](const std::string& name) {
    return run("git -C " DANCE_SOURCE_DIR " check-ignore -q --no-index logs/" + name).exit_code ==
           0;
  };
  EXPECT_FALSE(ignores("couple.lcm") || ignores("couple-packed.lcm") || ignores("README.md"));
  EXPECT_TRUE(ignores("2026-01-31-200000.lcm") && ignores("evening-packed.lcm"));
}

}  // namespace
}  // namespace dance
