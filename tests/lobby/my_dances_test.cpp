// The page of recordings in a real window: one is watched in a window of its own, and exported.
#include <gtest/gtest.h>

#include <filesystem>

#include "tests/lobby/typed_input.h"
#include "tests/lobby/window_on_screen.h"
#include "tests/virtual_display.h"

namespace dance {
namespace {

// Places in a window of 1280 by 720.
constexpr int kShelf_x = 100, kShelf_y = 270;
constexpr int kRow_x = 700, kRow_y = 120;
constexpr int kWatch_x = 335;  // left of the word
constexpr int kBelowRow_y = 155, kMyDancesToMiddle_px = 22;
constexpr int kFree_x = 700, kFree_y = 600;
constexpr int kExport_x = 648, kGlb_x = 439, kGlbBelow_px = 133;

class MyDances : public testing::Test {
 protected:
  void SetUp() override {
    if (display_.display().empty()) GTEST_SKIP() << kNoVirtualDisplay;
    setenv("DISPLAY", display_.display().c_str(), 1);
    unsetenv("WAYLAND_DISPLAY");
    setenv("XDG_VIDEOS_DIR", folder_.path("videos").c_str(), 1);
    setenv("XDG_RUNTIME_DIR", folder_.path("run").c_str(), 1);
    setenv("XDG_CACHE_HOME", folder_.path("cache").c_str(), 1);
    setenv("LC_ALL", "C", 1);
    std::filesystem::create_directories(folder_.path("run"));
    std::filesystem::create_directories(folder_.path("videos/DanceGraph"));
    std::filesystem::copy_file(DANCE_SOURCE_DIR "/logs/couple.lcm", dance("a.lcm"));
    input_ = std::make_unique<TypedInput>(display_.display());
    if (!input_->is_there()) GTEST_SKIP() << "no XTEST here; apt-get install libxtst6";
  }
  void TearDown() override { unsetenv("XDG_VIDEOS_DIR"); }
  std::string dance(const std::string& name) const {
    return folder_.path("videos/DanceGraph/" + name);
  }

  TestFolder folder_{"my-dances"};
  VirtualDisplay display_{folder_.path(), "1280x1000x24"};
  std::unique_ptr<TypedInput> input_;
  LobbyOnScreen window_{folder_, "config"};
};

TEST_F(MyDances, ARecordingIsExportedAndWatched) {
  window_.put_settings("[house]\nguest = \"ann\"\n[window]\nwidth = 1280\nheight = 720\n");
  window_.start();
  ASSERT_TRUE(wait_for([&] { return window_.shows_lobby(); })) << window_.talk();
  input_->click(kShelf_x, kShelf_y);
  // The row opens: the accent of its first button is seen.
  const auto watch_y = [&] { return window_.accent_below(kWatch_x, kBelowRow_y); };
  ASSERT_TRUE(wait_for([&] {
    if (watch_y() < 0) input_->click(kRow_x, kRow_y);
    return wait_for([&] { return watch_y() >= 0; }, std::chrono::seconds(2));
  })) << window_.talk();
  const int buttons_y = watch_y() + kMyDancesToMiddle_px;
  const auto glb_is_shown = [&] {
    return window_.pixel(kGlb_x - 27, buttons_y + kGlbBelow_px) != window_.pixel(kFree_x, kFree_y);
  };
  ASSERT_TRUE(wait_for([&] {
    if (!glb_is_shown()) input_->click(kExport_x, buttons_y);
    return wait_for(glb_is_shown, std::chrono::seconds(2));
  })) << window_.talk();
  // While the file is written the whole page is lower, so nothing is clicked then.
  EXPECT_TRUE(wait_for([&] {
    if (watch_y() + kMyDancesToMiddle_px == buttons_y && glb_is_shown())
      input_->click(kGlb_x, buttons_y + kGlbBelow_px);
    return wait_for([&] { return std::filesystem::exists(dance("a.glb")); },
                    std::chrono::seconds(2));
  })) << window_.talk();
  // A button below the mouse has another colour.
  input_->click(kFree_x, kFree_y);
  // A banner names the file that was written, so the buttons are lower now.
  EXPECT_TRUE(wait_for([&] { return watch_y() > buttons_y; }));
  EXPECT_TRUE(wait_for([&] {
    input_->click(kWatch_x + 50, watch_y() + kMyDancesToMiddle_px);
    return wait_for([&] { return window_.children("dance-view").size() == 1; },
                    std::chrono::seconds(2));
  })) << window_.talk();
  window_.program().ask_to_stop();
}

}  // namespace
}  // namespace dance
