// A link that was clicked: the window asks before it uses anything of the link. Once in this
// process, to look at what it opens, and with the built programs, mouse and keys.
#include <gtest/gtest.h>

#include <filesystem>

#include "core/program/child_process.h"
#include "house/session.h"
#include "lobby/run/lobby_run.h"
#include "tests/lobby/typed_input.h"
#include "tests/lobby/window_on_screen.h"
#include "tests/virtual_display.h"

namespace dance {
namespace {

constexpr const char* kHouse =
    "[house]\nguest = \"ann\"\n[[produce]]\nkind = \"salsa\"\nguest = \"ann\"\nrole = \"lead\"\n"
    "[window]\nwidth = 1280\nheight = 720\n";
// The column of the button Join in the dialog, in a window of 1280 x 720, and a height above it.
constexpr int kJoin_x = 600, kAboveJoin_y = 160, kJoinHalf_px = 20;

class LobbyLink : public testing::Test {
 protected:
  void SetUp() override {
    if (display_.display().empty()) GTEST_SKIP() << kNoVirtualDisplay;
    setenv("DISPLAY", display_.display().c_str(), 1);
    unsetenv("WAYLAND_DISPLAY");
    setenv("XDG_CONFIG_HOME", folder_.path("config").c_str(), 1);
    setenv("XDG_RUNTIME_DIR", folder_.path("run").c_str(), 1);
    setenv("LC_ALL", "C", 1);
    std::filesystem::create_directories(folder_.path("run"));
    input_ = std::make_unique<TypedInput>(display_.display());
    if (!input_->is_there()) GTEST_SKIP() << "no XTEST here; apt-get install libxtst6";
    window_.put_settings(kHouse);
  }
  // The server's keys are its operator's, not those of the window's user.
  void start_server() {
    setenv("XDG_CONFIG_HOME", folder_.path("operator").c_str(), 1);
    auto started = ChildProcess::start({bin("dance-server"), {}, "", folder_.path("server")});
    setenv("XDG_CONFIG_HOME", folder_.path("config").c_str(), 1);
    ASSERT_TRUE(started);
    server_ = std::make_unique<ChildProcess>(std::move(*started));
    ASSERT_TRUE(wait_for(
        [&] { return text_of(folder_.path("server")).find("hears on") != std::string::npos; }));
  }
  std::string link_for(const std::string& guest) {
    const Finished made =
        run("export XDG_CONFIG_HOME=" + folder_.path("operator") + "; " + bin("dance-server") +
            " --invite " + guest + " --address 127.0.0.1 --room salsa");
    EXPECT_TRUE(made.output.starts_with("dance://")) << made.talk;
    return made.output.substr(0, made.output.find('\n'));
  }
  void open(const std::string& link) {
    window_.start({link});
    ASSERT_TRUE(window_.is_started());
  }
  // The dialog dims everything except its own buttons.
  int join_y() const { return window_.accent_below(kJoin_x, kAboveJoin_y); }
  bool asks() const { return join_y() >= 0 && !window_.shows_lobby(); }
  // A click right after the question appears counts for nothing, and a button under the mouse has
  // another colour.
  void confirm() {
    EXPECT_TRUE(wait_for([&] {
      if (asks()) input_->click(kJoin_x, join_y() + kJoinHalf_px);
      std::this_thread::sleep_for(std::chrono::milliseconds(300));
      input_->move(20, 20);
      std::this_thread::sleep_for(std::chrono::milliseconds(300));
      return wait_for([&] { return !asks(); }, std::chrono::seconds(2));
    })) << window_.talk();
  }
  bool has_used_nothing() {
    EXPECT_EQ(text_of(window_.settings()), kHouse);
    EXPECT_FALSE(std::filesystem::exists(folder_.path("config/dance/invitations")));
    EXPECT_FALSE(std::filesystem::exists(folder_.path("config/dance/keys")));
    EXPECT_FALSE(std::filesystem::exists(window_.settings() + ".trial.toml"));
    EXPECT_TRUE(window_.children("dance-join").empty());
    EXPECT_TRUE(window_.children("dance-capture").empty());
    return !HasFailure();
  }

  TestFolder folder_{"lobby-link"};
  VirtualDisplay display_{folder_.path(), "1280x1000x24"};
  std::unique_ptr<TypedInput> input_;
  std::unique_ptr<ChildProcess> server_;
  LobbyOnScreen window_{folder_, "config"};
};

TEST_F(LobbyLink, JoinsNothingAndChangesNothingWhenItIsCancelled) {
  start_server();
  const std::string link = link_for("bob");
  open(link);
  ASSERT_TRUE(wait_for([&] { return asks(); })) << window_.talk();
  EXPECT_TRUE(has_used_nothing());
  input_->move(20, 20);
  input_->press("Escape");
  ASSERT_TRUE(wait_for([&] { return window_.shows_lobby(); }));
  EXPECT_TRUE(has_used_nothing());
  // The invitation still opens: nobody has taken its key.
  const Finished opened = run("printf '%s' '" + link + "' | " + bin("dance-key"));
  EXPECT_EQ(opened.exit_code, 0) << opened.talk;
}

TEST_F(LobbyLink, JoinsWhenItIsConfirmedAndIsThenKnown) {
  start_server();
  const std::string link = link_for("bob");
  open(link);
  ASSERT_TRUE(wait_for([&] { return asks(); })) << window_.talk();
  confirm();
  EXPECT_TRUE(wait_for([&] { return window_.dances(); })) << window_.talk();
  const auto house = load_session(window_.settings());
  ASSERT_TRUE(house) << house.error().what;
  EXPECT_EQ(house->guests.front().view(), "bob") << "the name that the key is for";
  EXPECT_EQ(house->room, "salsa");
  ASSERT_EQ(house->window.rooms.size(), 1u);
  EXPECT_EQ(house->window.rooms.front().text(), "salsa@127.0.0.1:7400");
  EXPECT_FALSE(std::filesystem::exists(window_.settings() + ".trial.toml"));
  EXPECT_EQ(window_.talk().find("key="), std::string::npos);

  // The same link again joins by itself: the kept key proves that it is the same server.
  window_.program().stop(Duration::s(10));
  open(link);
  EXPECT_TRUE(wait_for([&] { return window_.dances(); })) << window_.talk();

  // Another key for the same room and name proves nothing of the kind.
  window_.program().stop(Duration::s(10));
  ASSERT_EQ(run("export XDG_CONFIG_HOME=" + folder_.path("operator") + "; " + bin("dance-server") +
                " --remove-key bob")
                .exit_code,
            0);
  open(link_for("bob"));
  EXPECT_TRUE(wait_for([&] { return asks(); })) << window_.talk();
  EXPECT_TRUE(window_.children("dance-join").empty());
}

TEST_F(LobbyLink, LeavesTheHouseFileAsItWasWhenTheServerRefusesTheHouse) {
  start_server();
  // Somebody dances as bob already, with the key of the server's own machine.
  setenv("XDG_CONFIG_HOME", folder_.path("operator").c_str(), 1);
  auto other = ChildProcess::start(
      {bin("dance-link"),
       {"--guest", "bob", "--room", "salsa", "--bus", "udpm://239.255.76.67:17691?ttl=0"},
       "",
       folder_.path("other")});
  setenv("XDG_CONFIG_HOME", folder_.path("config").c_str(), 1);
  ASSERT_TRUE(other);
  ASSERT_TRUE(wait_for([&] {
    return text_of(folder_.path("other")).find("in room 'salsa'") != std::string::npos;
  })) << text_of(folder_.path("other"));
  open(link_for("bob"));
  ASSERT_TRUE(wait_for([&] { return asks(); })) << window_.talk();
  confirm();
  EXPECT_TRUE(wait_for([&] { return window_.shows_lobby() && window_.shows_error_banner(); }))
      << window_.talk();
  EXPECT_EQ(text_of(window_.settings()), kHouse);
  EXPECT_FALSE(std::filesystem::exists(window_.settings() + ".trial.toml"));
}

// Runs the lobby in this process, as the programs that list cameras live too short to be seen.
TEST_F(LobbyLink, OpensNoDeviceUntilItIsAnswered) {
  start_server();
  auto lobby = LobbyRun::create(window_.settings(), link_for("bob"));
  ASSERT_TRUE(lobby) << lobby.error().what;
  LobbyModel& model = (*lobby)->model();
  const auto turn_until = [&](const auto& is_so) {
    return wait_for([&] { return !(*lobby)->turn() || is_so(); });
  };
  ASSERT_TRUE(turn_until([&] { return (*lobby)->pictures() > 2; }));
  ASSERT_TRUE(model.join_request);
  EXPECT_EQ(model.join_request->room + "@" + model.join_request->server, "salsa@127.0.0.1");
  EXPECT_EQ(model.join_request->guest, "bob");
  EXPECT_FALSE(model.knows_cameras) << "they were looked for";
  // Not even on the page that shows the camera.
  model.screen = LobbyScreen::kYou;
  model.settings.source = DancerSource::kCamera;
  model.settings.speaks = model.sound.is_tested = true;
  model.cameras = {{"/dev/video0", "HD Webcam", ""}};
  const int before = (*lobby)->pictures();
  model.tell({LobbyBanner::Kind::kGood, Text::kLobbyNoGraphics, {}, ""});
  ASSERT_TRUE((*lobby)->turn());
  EXPECT_GE((*lobby)->pictures(), before);
  EXPECT_FALSE(model.sound.is_tested) << "the test of the sound has ended";
  EXPECT_EQ(model.preview_texture, nullptr);
  model.screen = LobbyScreen::kDance;
  model.cameras.clear();
  model.wish = LobbyWish::kCancel;
  EXPECT_TRUE(turn_until([&] {
    if (model.join_request && model.wish == LobbyWish::kNone) model.wish = LobbyWish::kCancel;
    input_->move(30 + (*lobby)->pictures() % 7, 30);  // so that it draws
    return model.knows_cameras;
  }));
  EXPECT_FALSE(model.join_request);
}

TEST_F(LobbyLink, ShowsNoTextThatCouldMeanAnotherPlace) {
  // An override of the writing direction, a line end, a terminal's escape, and a host too long.
  for (const std::string& host : {std::string("ex%E2%80%AEample.org"),
                                  std::string("example.org%0a"), std::string("%1b[2Jexample.org"),
                                  std::string(254, 'a'), std::string("ex\u202eample.org")}) {
    auto lobby = LobbyRun::create(
        window_.settings(),
        "dance://" + host +
            "/salsa?v=2&guest=bob&server=x&key=x&until=20990101T0000Z&check=00000000");
    ASSERT_TRUE(lobby) << lobby.error().what;
    const LobbyModel& model = (*lobby)->model();
    EXPECT_FALSE(model.join_request) << host;
    ASSERT_EQ(model.banners.size(), 1u);
    EXPECT_EQ(model.banners.front().text, Text::kLobbyInvitationBad);
    EXPECT_NE(model.banners.front().detail.find("names no server"), std::string::npos);
    EXPECT_EQ(model.banners.front().detail.find(host), std::string::npos);
  }
}

}  // namespace
}  // namespace dance
