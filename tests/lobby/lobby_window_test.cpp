// The whole way in a real window, with mouse and keys: from the lobby to the dance and back; the
// window stays when the house does not.
#include <gtest/gtest.h>

#include <csignal>
#include <filesystem>
#include <set>
#include <thread>

#include "core/program/child_process.h"
#include "house/session.h"
#include "tests/lobby/typed_input.h"
#include "tests/lobby/window_on_screen.h"
#include "tests/virtual_display.h"

namespace dance {
namespace {

constexpr int kScreenWidth_px = 1280, kScreenHeight_px = 720;
// Where things are in a window of that size.
constexpr int kAlone_x = 500, kAlone_y = 160;
constexpr int kRoom_x = 1028, kRoomHalf_px = 25;  // only the rows of rooms reach it
constexpr int kBannerButton_x = 1080, kBannerButton_y = 52;
constexpr int kHost_x = 100, kHost_y = 216;

class LobbyWindowTest : public testing::Test {
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
  }
  std::string settings() const { return window_.settings(); }
  void put_settings(const std::string& text) { window_.put_settings(text); }
  void open_lobby() {
    window_.start();
    ASSERT_TRUE(window_.is_started());
    ASSERT_TRUE(wait_for([&] { return window_.shows_lobby() || has_ended(); })) << talk();
    ASSERT_FALSE(has_ended()) << talk();
  }
  bool has_ended() { return window_.program().has_ended(); }
  std::string talk() const { return window_.talk(); }
  // Again until it is heard: while it goes in, the lobby is still there, and darker.
  void leave() {
    EXPECT_TRUE(wait_for([&] {
      if (!window_.is_back()) input_->press("q");
      return wait_for([&] { return window_.is_back(); }, std::chrono::seconds(2));
    })) << talk();
  }
  void click_until(int x, int y, const std::function<bool()>& condition) {
    input_->click(x, y);
    EXPECT_TRUE(wait_for(condition)) << talk();
  }

  TestFolder folder_{"lobby-window"};
  VirtualDisplay display_{folder_.path(), "1280x1240x24"};
  std::unique_ptr<TypedInput> input_;
  LobbyOnScreen window_{folder_, "config"};
};

constexpr const char* kSynthetic =
    "[house]\nguest = \"ann\"\n[[produce]]\nkind = \"salsa\"\nguest = \"ann\"\nrole = \"lead\"\n"
    "[window]\nwidth = 1280\nheight = 720\n";
constexpr const char* kHighWithARoom =
    "[house]\nguest = \"ann\"\n[[produce]]\nkind = \"salsa\"\nguest = \"ann\"\n"
    "[window]\nwidth = 1280\nheight = 1240\nrooms = [\"salsa@127.0.0.1:7499\"]\n";

TEST_F(LobbyWindowTest, OneClickIsADanceWithAPartnerAndQIsTheWayBack) {
  put_settings(kSynthetic);
  open_lobby();
  click_until(kAlone_x, kAlone_y, [&] { return window_.dances(); });
  std::set<std::string> pictures;
  EXPECT_TRUE(wait_for([&] {
    pictures.insert(text_of(folder_.path("Xvfb_screen0")));
    return pictures.size() > 5;
  })) << "they move";
  leave();
  EXPECT_FALSE(has_ended());
  click_until(kAlone_x, kAlone_y, [&] { return window_.dances(); });
  window_.program().ask_to_stop();
  EXPECT_TRUE(wait_for([&] { return has_ended(); })) << "from within the dance too";
  EXPECT_TRUE(window_.program().ended_well()) << window_.program().exit_text() << talk();
  EXPECT_EQ(text_of(settings()), kSynthetic) << "nothing was chosen";
}

TEST_F(LobbyWindowTest, KeysAloneDoAsWell) {
  put_settings(kSynthetic);
  open_lobby();
  input_->move(kScreenWidth_px - 20, kScreenHeight_px - 20);  // keys go where the mouse is
  // The first key shows where the keys are: at the big button, and the next one back there.
  EXPECT_TRUE(wait_for([&] {
    for (const char* key : {"Down", "Up", "Return"}) {
      if (!window_.children("dance-join").empty()) break;
      input_->press(key);
      std::this_thread::sleep_for(std::chrono::milliseconds(300));
    }
    return wait_for([&] { return window_.dances(); }, std::chrono::seconds(5));
  })) << talk();
  leave();
}

TEST_F(LobbyWindowTest, AHouseThatDiesIsTroubleAndTheWindowStays) {
  put_settings(kSynthetic);
  open_lobby();
  click_until(kAlone_x, kAlone_y, [&] { return window_.dances(); });
  ASSERT_TRUE(send_signal(window_.children("dance-join").front(), SIGKILL));
  EXPECT_TRUE(wait_for([&] { return window_.is_back() && window_.shows_error_banner(); }))
      << talk();
  EXPECT_FALSE(has_ended());
}

TEST_F(LobbyWindowTest, AServerThatIsSilentIsTroubleInTheLobby) {
  put_settings(kHighWithARoom);
  open_lobby();
  // Once the list knows that the server is silent the banner appears at once, and offers to try
  // anyway; a click before that tries to join.
  std::this_thread::sleep_for(std::chrono::seconds(8));
  click_until(kRoom_x, window_.lowest_row(kRoom_x) - kRoomHalf_px,
              [&] { return window_.shows_error_banner(); });
  EXPECT_TRUE(window_.children("dance-join").empty());
  click_until(kBannerButton_x, kBannerButton_y,
              [&] { return !window_.children("dance-join").empty(); });
  EXPECT_TRUE(wait_for([&] { return window_.is_back() && window_.shows_error_banner(); }))
      << talk();
  EXPECT_FALSE(has_ended());
  EXPECT_EQ(load_session(settings())->server, "127.0.0.1:7499");
}

TEST_F(LobbyWindowTest, ABrokenFileIsToldAndKept) {
  put_settings("[house]\nguest = \"ann\"\nrom = \"salsa\"\n");
  open_lobby();
  EXPECT_TRUE(wait_for([&] { return window_.shows_error_banner(); }));
  int kept = 0;
  for (const auto& it : std::filesystem::directory_iterator(folder_.path("config/dancegraph")))
    kept += it.path().string().find("house.toml.broken-") != std::string::npos ? 1 : 0;
  EXPECT_EQ(kept, 1);
}

TEST_F(LobbyWindowTest, ARoomIsOpenedHereAndEndsWithTheWindow) {
  put_settings(kSynthetic);
  open_lobby();
  input_->click(kHost_x, kHost_y);
  // The big button of the screen before is gone.
  ASSERT_TRUE(wait_for([&] { return window_.pixel(500, 170) != 0xff8b66; }));
  EXPECT_TRUE(wait_for([&] {
    if (window_.children("dance-server").empty()) input_->click(420, 143);
    std::this_thread::sleep_for(std::chrono::milliseconds(700));
    return run(bin("dance-status") + " --once --json").exit_code == 0;
  })) << talk();
  window_.program().ask_to_stop();
  EXPECT_TRUE(wait_for([&] { return has_ended(); }));
  EXPECT_TRUE(wait_for([&] { return run(bin("dance-status") + " --once").exit_code != 0; }));
}

}  // namespace
}  // namespace dance
