// The dance panel in a real window, under a virtual display: what it asks for, the window does.
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>

#include "core/net/mono_clock.h"
#include "tests/test_folder.h"
#include "tests/viewer/board_source.h"
#include "tests/viewer/driver_memory.h"
#include "tests/viewer/test_scene.h"
#include "tests/virtual_display.h"
#include "viewer/window/window_run.h"

namespace dance {
namespace {

// With what a dance tells of itself.
class DancingHouse final : public BoardSource {
 public:
  DanceBoard* dance() override { return &dance_; }
  void put(const SceneState& scene) {
    BoardSource::put(scene);
    for (const SceneGuest& guest : scene.guests) {
      GuestStatus status;
      status.alive = status.remote = true;
      status.received = sequence();
      dance_.on_status(guest.id, status, mono_now());
      dance_.on_traffic(guest.id, mono_now());
    }
  }

 private:
  DanceBoard dance_;
};

class DanceWindowTest : public testing::Test {
 protected:
  void SetUp() override {
    if (display_.display().empty()) GTEST_SKIP() << kNoVirtualDisplay;
    setenv("DISPLAY", display_.display().c_str(), 1);
    options_.size = {780, 560};
    options_.camera = CameraPreset::kFront;
    options_.quality = QualityWish::kHigh;
    options_.hud = false;
    options_.language = Language::kEnglish;
    source_.put(couple());
    auto run = WindowRun::create(options_, source_);
    if (!run) GTEST_SKIP() << run.error().what;
    run_ = std::move(*run);
    keep_drivers_loaded();
    turn();
  }
  void turn() {
    source_.put(couple());
    ASSERT_TRUE(run_->turn());
  }
  void press(int key) {
    KeyPress pressed;
    pressed.key = key;
    run_->input().on_key(pressed);
    turn();
  }
  bool shows(const char* name) const {
    for (const SceneGuest& guest : run_->scene().guests)
      if (guest.id.view() == name) return true;
    return false;
  }

  const VirtualDisplay display_;
  ViewOptions options_;
  DancingHouse source_;
  std::unique_ptr<WindowRun> run_;
};

TEST_F(DanceWindowTest, EscOpensThePanelAndQClosesTheWindow) {
  for (int i = 0; i < 4; ++i) {
    press(GLFW_KEY_ESCAPE);
    EXPECT_FALSE(run_->is_over());
  }
  press(GLFW_KEY_Q);
  EXPECT_TRUE(run_->is_over());
  EXPECT_FALSE(run_->state().has_left) << "closed, not left for elsewhere";
}

TEST_F(DanceWindowTest, LeaveIsReachedByKeysAndTellsTheProgramAroundIt) {
  press(GLFW_KEY_ESCAPE);
  press(GLFW_KEY_UP);  // the last control
  press(GLFW_KEY_ENTER);
  turn();
  EXPECT_TRUE(run_->is_over());
  EXPECT_TRUE(run_->state().has_left);
}

TEST_F(DanceWindowTest, AHiddenGuestIsNotDrawnAndComesBack) {
  ASSERT_TRUE(shows("bob"));
  run_->wishes().hidden.push_back(*GuestId::parse("bob"));
  turn();
  EXPECT_FALSE(shows("bob"));
  EXPECT_TRUE(shows("alice"));
  run_->wishes().hidden.clear();
  turn();
  EXPECT_TRUE(shows("bob"));
}

TEST_F(DanceWindowTest, DrawsPlainlyFromTheNextPictureOn) {
  ASSERT_EQ(run_->painter().renderer().quality(), Quality::kHigh);
  press(GLFW_KEY_ESCAPE);
  run_->wishes().draws_plainly = true;
  turn();
  EXPECT_EQ(run_->painter().renderer().quality(), Quality::kLow);
  EXPECT_FALSE(run_->wishes().draws_plainly);
  turn();
  press(GLFW_KEY_UP);
  press(GLFW_KEY_ENTER);
  turn();
  EXPECT_TRUE(run_->state().has_left) << "the panel goes on";
}

TEST_F(DanceWindowTest, AHostWhoClosesTheWindowIsAskedWhileOthersAreThere) {
  options_.hosts_room = true;
  turn();
  const auto close = [&] {
    glfwSetWindowShouldClose(run_->window().handle(), GLFW_TRUE);
    turn();
  };
  close();
  EXPECT_FALSE(run_->is_over()) << "the room ends for alice and bob";
  press(GLFW_KEY_ESCAPE);
  turn();
  EXPECT_FALSE(run_->is_over());
  EXPECT_EQ(run_->wishes().closing, Closing::kNo) << "stays";
  press(GLFW_KEY_Q);
  EXPECT_FALSE(run_->is_over());
  press(GLFW_KEY_ENTER);
  turn();
  EXPECT_TRUE(run_->is_over());
}

TEST_F(DanceWindowTest, AHostMayInsistByClosingTwice) {
  options_.hosts_room = true;
  for (int i = 0; i < 2; ++i) {
    EXPECT_FALSE(run_->is_over());
    glfwSetWindowShouldClose(run_->window().handle(), GLFW_TRUE);
    turn();
  }
  EXPECT_TRUE(run_->is_over());
}

TEST_F(DanceWindowTest, KTakesAPictureOfTheStageWithoutThePanel) {
  const TestFolder folder("dance-window-picture");
  setenv("XDG_VIDEOS_DIR", folder.path("").c_str(), 1);
  const auto files = [&] {
    std::vector<std::string> names;
    const std::filesystem::path videos(folder.path("DanceGraph"));
    if (std::filesystem::exists(videos))
      for (const auto& file : std::filesystem::directory_iterator(videos))
        names.push_back(file.path().extension().string());
    return names;
  };
  press(GLFW_KEY_ESCAPE);
  press(GLFW_KEY_K);
  EXPECT_EQ(files(), std::vector<std::string>{".png"});
  turn();
  EXPECT_EQ(files().size(), 1u) << "once";
  const auto& notes = run_->scene().notes;
  EXPECT_TRUE(std::any_of(notes.begin(), notes.end(), [](const std::string& note) {
    return note.starts_with("Picture saved: ");
  }));
  unsetenv("XDG_VIDEOS_DIR");
}

TEST_F(DanceWindowTest, F11FillsTheScreenAndTheWindowComesBackForTheLobby) {
  press(GLFW_KEY_F11);
  if (!run_->window().is_full_screen()) GTEST_SKIP() << "this display knows no monitor";
  turn();
  EXPECT_TRUE(run_->window().is_full_screen());
  auto window = WindowRun::close(std::move(run_));
  EXPECT_FALSE(window->is_full_screen());
}

TEST_F(DanceWindowTest, ShowsTheSlowDrawingNoteOnceForSeveralDances) {
  EXPECT_FALSE(run_->wishes().knows_slow_drawing);
  run_->wishes().knows_slow_drawing = true;
  auto window = WindowRun::close(std::move(run_));
  auto again = WindowRun::create(options_, source_, std::move(window));
  ASSERT_TRUE(again) << again.error().what;
  run_ = std::move(*again);
  EXPECT_TRUE(run_->wishes().knows_slow_drawing);
}

TEST_F(DanceWindowTest, TheVoicesKeysAreTold) {
  run_->wishes().mute_presses = 1;
  turn();
  EXPECT_EQ(run_->wishes().mute_presses, 0);
}

}  // namespace
}  // namespace dance
