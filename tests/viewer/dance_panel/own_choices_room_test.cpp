// Two houses and a server as programs: a name and a figure that a window of one house
// changes during the dance are seen in the other house, also by one that joins later.
#include <gtest/gtest.h>

#include <cstdlib>

#include "tests/apps/bus_programs.h"
#include "viewer/dance_panel/own/figure_controller.h"
#include "viewer/feed/stage_feed.h"

namespace dance {
namespace {

constexpr const char* kOwnServer = "127.0.0.1:7464";

class OwnChoicesInARoom : public BusPrograms {
 protected:
  void SetUp() override {
    setenv("XDG_DATA_HOME", folder_.path("data").c_str(), 1);
    setenv("XDG_CACHE_HOME", folder_.path("cache").c_str(), 1);
    start("dance-server", {"--port", "7464", "--bind", "127.0.0.1"});
  }
  void TearDown() override {
    unsetenv("XDG_DATA_HOME");
    unsetenv("XDG_CACHE_HOME");
  }
  void join(const char* guest, const char* bus) {
    start("dance-join",
          {kOwnServer, "--room", "salsa", "--guest", guest, "--bus", bus, "--no-view"});
  }
  bool change_figure(FigureController& desk, const OwnFigure& figure) {
    desk.choose(*GuestId::parse("alice"), figure);
    return wait_for([&] {
      desk.work();
      return !desk.is_busy();
    });
  }
};

TEST_F(OwnChoicesInARoom, NameAndFigureArriveInTheOtherHouse) {
  const GuestId alice = *GuestId::parse("alice");
  join("alice", kBus);
  ASSERT_TRUE(wait_for([&] {
    return text_of(folder_.path("talk")).find("in room 'salsa'") != std::string::npos;
  })) << text_of(folder_.path("talk"));
  FeedOptions options;
  options.bus_url = kBus;
  auto window = StageFeed::create(options);
  ASSERT_TRUE(window) << window.error().what;
  FigureController::Needs needs;
  needs.program = bin("dance-avatar");
  needs.bus = kBus;
  FigureController desk(needs);
  const auto rename = [&](const char* name) {
    (*window)->dance().rename(alice, *parse_shown_name(name));
    (*window)->wake();
  };
  rename("Ana");
  OwnFigure figure;
  figure.look = "dress-bun";
  ASSERT_TRUE(change_figure(desk, figure));
  EXPECT_EQ(desk.trouble(), "");

  // Bob's house joins after the change.
  auto ear = Bus::open(kOtherBus);
  ASSERT_TRUE(ear);
  std::string name, avatar, file;
  (*ear)->subscribe<Profile>(
      {Where::kGuest, alice},
      [&](const Channel&, const Profile& profile, MonoTime) { name = profile.shown_name.view(); });
  (*ear)->subscribe<Avatar>({Where::kGuest, alice}, [&](const Channel&, const Avatar& it,
                                                        MonoTime) { avatar = it.name.view(); });
  (*ear)->subscribe<AvatarFile>({Where::kGuest, alice}, [&](const Channel&, const AvatarFile& it,
                                                            MonoTime) { file = it.name.view(); });
  const auto comes_to = [&](const auto& condition) {
    return wait_for([&] {
      (*ear)->drain(mono_now());
      return condition();
    });
  };
  join("bob", kOtherBus);
  ASSERT_TRUE(comes_to([&] { return name == "Ana" && avatar == "dress-bun"; }))
      << name << ' ' << avatar << text_of(folder_.path("talk"));
  EXPECT_EQ(file, "");

  rename("Ana B");
  figure = OwnFigure();
  figure.what = DANCE_SOURCE_DIR "/data/avatars/teo.vrm";
  ASSERT_TRUE(change_figure(desk, figure));
  EXPECT_EQ(desk.trouble(), "");
  ASSERT_TRUE(comes_to([&] { return name == "Ana B" && file == "teo.vrm"; }))
      << name << ' ' << file << text_of(folder_.path("talk"));
}

}  // namespace
}  // namespace dance
