// Two windows on one machine, with mouse and keys: one opens a room and invites, the other pastes
// the invitation; both dance, and each shows the other. With DANCE_PICTURES=DIR what was on the
// screen is kept there, as X window dumps.
#include <gtest/gtest.h>

#include <filesystem>

#include "core/bus/bus.h"
#include "core/net/mono_clock.h"
#include "house/session.h"
#include "tests/lobby/typed_input.h"
#include "tests/lobby/window_on_screen.h"
#include "tests/virtual_display.h"

namespace dance {
namespace {

constexpr int kGuest_x = 1280;  // the second window is at the right of the first
// Positions in a window of 1280 x 1100, high enough for the last button of an invitation.
constexpr int kHostScreen_x = 100, kHostScreen_y = 216;
constexpr int kOpenRoom_x = 420, kOpenRoom_y = 143;
constexpr int kJoinOwn_x = 560, kJoinOwn_y = 142;
constexpr int kName_x = 640, kAddress_x = 480;
constexpr int kFields_x = 700;                 // in both of these fields, right of the text
constexpr int kFieldHalf_px = 140;             // of what is looked at
constexpr int kInvite_x = 340, kCopy_x = 332;  // at the edges of the buttons, beside their labels
constexpr int kPaste_x = 975, kOpenInvitation_x = 407;
constexpr int kOpenFrom_x = 335, kBelowTiles_y = 300;  // what is between depends on the build
constexpr int kToMiddle_px = 22, kFieldAbove_px = 54;
// The column of Join in the question, and a height above it.
constexpr int kConfirm_x = 600, kAboveConfirm_y = 300;
// In the middle of the field with the invitation.
constexpr int kPastedFrom_x = 340, kPastedTo_x = 700;

std::string settings_of_dancer(const char* name, const char* role, const char* bus) {
  return "[house]\nguest = \"" + std::string(name) + "\"\nbus = \"" + bus +
         "\"\n[[produce]]\nkind = \"salsa\"\nguest = \"" + name + "\"\nrole = \"" + role +
         "\"\n[window]\nwidth = 1280\nheight = 1100\n";
}

// What a house stages of a guest, and what its window has shown.
class HouseEar {
 public:
  HouseEar(const char* url, const GuestId& guest) : bus_(*Bus::open(url)) {
    bus_->subscribe<Pose>({Where::kStage, guest},
                          [this](const Channel&, const Pose&, MonoTime) { ++staged_; });
    bus_->subscribe<StageTime>({Where::kView, guest},
                               [this](const Channel&, const StageTime&, MonoTime) { ++shown_; });
  }
  bool has_shown() {
    bus_->drain(mono_now());
    return staged_ >= 30 && shown_ >= 3;  // drawn by the processor
  }
  std::string text() const {
    return std::to_string(staged_) + " staged, " + std::to_string(shown_) + " shown";
  }

 private:
  std::unique_ptr<Bus> bus_;
  int staged_ = 0, shown_ = 0;
};

class TwoWindowsTest : public testing::Test {
 protected:
  void SetUp() override {
    if (display_.display().empty()) GTEST_SKIP() << kNoVirtualDisplay;
    setenv("DISPLAY", display_.display().c_str(), 1);
    unsetenv("WAYLAND_DISPLAY");
    setenv("XDG_RUNTIME_DIR", folder_.path("run").c_str(), 1);
    setenv("LC_ALL", "C", 1);
    std::filesystem::create_directories(folder_.path("run"));
    input_ = std::make_unique<TypedInput>(display_.display());
    if (!input_->is_there()) GTEST_SKIP() << "no XTEST here; apt-get install libxtst6";
  }
  void TearDown() override { keep("end"); }
  void keep(const std::string& name) const {
    const char* folder = std::getenv("DANCE_PICTURES");
    if (folder != nullptr && std::filesystem::exists(folder_.path("Xvfb_screen0")))
      std::filesystem::copy_file(folder_.path("Xvfb_screen0"),
                                 std::string(folder) + "/two-windows-" + name + ".xwd",
                                 std::filesystem::copy_options::overwrite_existing);
  }
  // Until the window has taken it: it may be busy with what was before.
  template <class Condition>
  [[nodiscard]] bool click_until(int x, int y, const Condition& is_so) {
    return wait_for([&] {
      input_->click(x, y);
      return wait_for(is_so, std::chrono::seconds(3));
    });
  }
  // As people do: the mouse stays for a moment where it has clicked.
  void click(int x, int y) {
    input_->click(x, y);
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
  }
  [[nodiscard]] bool type_at(int x, int y, std::string_view text) {
    // The field has a cursor, or what was typed before.
    if (!click_until(x, y, [&] { return is_bright(x - kFieldHalf_px, x + kFieldHalf_px, y); }))
      return false;
    input_->type(text);
    return true;
  }
  bool is_bright(int from_x, int to_x, int y) const {
    const ScreenDump screen = host_.screen();
    for (int x = from_x; x < to_x; ++x)
      if ((screen.pixel(x, y) & 0xff) > 0xa0) return true;
    return false;
  }
  bool has_pasted(int y) const {
    return is_bright(kGuest_x + kPastedFrom_x, kGuest_x + kPastedTo_x, y);
  }
  std::string talk() const { return host_.talk() + "\n" + guest_.talk(); }

  TestFolder folder_{"two-windows"};
  VirtualDisplay display_{folder_.path(), "2560x1100x24"};
  std::unique_ptr<TypedInput> input_;
  LobbyOnScreen host_{folder_, "host"}, guest_{folder_, "guest", kGuest_x};
};

TEST_F(TwoWindowsTest, OneInvitesTheOtherAndBothDanceTogether) {
  constexpr const char* kHostBus = "udpm://239.255.76.67:17681?ttl=0";
  constexpr const char* kGuestBus = "udpm://239.255.76.67:17682?ttl=0";
  host_.put_settings(settings_of_dancer("ann", "lead", kHostBus));
  guest_.put_settings(settings_of_dancer("gast", "follow", kGuestBus));
  guest_.start();
  ASSERT_TRUE(guest_.is_started());
  ASSERT_TRUE(wait_for([&] {
    return input_->move_top_window(kGuest_x, 0) && guest_.shows_lobby();
  })) << talk();
  host_.start();
  ASSERT_TRUE(host_.is_started());
  ASSERT_TRUE(wait_for([&] { return host_.shows_lobby(); })) << talk();

  // The host opens a room, and invites bob.
  ASSERT_TRUE(click_until(kHostScreen_x, kHostScreen_y,
                          [&] { return host_.pixel(500, 170) != LobbyOnScreen::kAccent; }));
  // Once: what closes the room is at the same place then.
  click(kOpenRoom_x, kOpenRoom_y);
  ASSERT_TRUE(wait_for([&] { return !host_.children("dance-server").empty(); })) << talk();
  keep("hosts");
  ASSERT_TRUE(wait_for([&] {
    return host_.pixel(kJoinOwn_x, kJoinOwn_y) == LobbyOnScreen::kAccent;
  })) << talk();
  const std::vector<int> fields = host_.row_middles(kFields_x);
  ASSERT_GE(fields.size(), 2u);
  ASSERT_TRUE(type_at(kName_x, fields[0], "bob"));
  ASSERT_TRUE(type_at(kAddress_x, fields[1], "127.0.0.1"));
  keep("invites");
  const int invite_y = host_.accent_below(kInvite_x, fields[1]) + kToMiddle_px;
  ASSERT_TRUE(click_until(kInvite_x, invite_y, [&] {
    return run(bin("dance-server") + " --list-keys").output.find("bob") != std::string::npos;
  })) << talk();

  // The guest pastes it. The host copies until there is something to copy.
  const int open_y = guest_.accent_below(kOpenFrom_x, kBelowTiles_y) + kToMiddle_px;
  ASSERT_TRUE(wait_for([&] {
    const std::vector<int> buttons = host_.row_middles(kCopy_x, invite_y);
    if (!buttons.empty()) click(kCopy_x, buttons.front());
    click(kGuest_x + kPaste_x, open_y - kFieldAbove_px);
    return wait_for([&] { return has_pasted(open_y - kFieldAbove_px); }, std::chrono::seconds(1));
  })) << talk();
  keep("invited");
  ASSERT_TRUE(click_until(kGuest_x + kOpenInvitation_x, open_y, [&] {
    return !guest_.shows_lobby();
  })) << talk();
  // The question whether to join dims all else.
  const auto join_y = [&] { return guest_.accent_below(kConfirm_x, kAboveConfirm_y); };
  ASSERT_TRUE(wait_for([&] { return join_y() >= 0; })) << talk();
  keep("asked");
  // While a window goes in, and when it is in, there is nothing at these places.
  ASSERT_TRUE(click_until(kGuest_x + kConfirm_x, join_y() + kToMiddle_px, [&] {
    return guest_.dances();
  })) << talk();
  ASSERT_TRUE(click_until(kJoinOwn_x, kJoinOwn_y, [&] { return host_.dances(); })) << talk();

  // Each stages the other, and its window has shown that.
  HouseEar host(kHostBus, *GuestId::parse("bob")), guest(kGuestBus, *GuestId::parse("ann"));
  EXPECT_TRUE(wait_for([&] {
    const bool shows_bob = host.has_shown(), shows_ann = guest.has_shown();
    return shows_bob && shows_ann;
  })) << host.text()
      << "; " << guest.text() << talk();
  keep("together");
  const auto house = load_session(guest_.settings());
  ASSERT_TRUE(house) << house.error().what;
  EXPECT_EQ(house->guests.front().view(), "bob") << "by the name that the invitation is for";
  EXPECT_EQ(talk().find("key="), std::string::npos);
}

}  // namespace
}  // namespace dance
