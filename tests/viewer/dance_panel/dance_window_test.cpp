// The dance panel in a real window, under a virtual display: what it asks for, the window does.
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <gtest/gtest.h>

#include <cstdlib>

#include "core/net/mono_clock.h"
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

TEST_F(DanceWindowTest, TheVoicesKeysAreTold) {
  run_->wishes().mute_presses = 1;
  turn();
  EXPECT_EQ(run_->wishes().mute_presses, 0);
}

}  // namespace
}  // namespace dance
