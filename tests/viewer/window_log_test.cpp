// A window on a recording: its keys, and exports that go on while it shows.

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <memory>

#include "tests/test_folder.h"
#include "tests/viewer/driver_memory.h"
#include "tests/viewer/replay/recorded_night.h"
#include "tests/virtual_display.h"
#include "viewer/replay/replay_source.h"
#include "viewer/window/printed_keys.h"
#include "viewer/window/window_run.h"

namespace dance {
namespace {

class WindowLogTest : public testing::Test {
 protected:
  void SetUp() override {
    if (display_.display().empty()) GTEST_SKIP() << kNoVirtualDisplay;
    setenv("DISPLAY", display_.display().c_str(), 1);
    // Exports go into the present folder.
    before_ = std::filesystem::current_path();
    std::filesystem::current_path(folder_.path());
    options_.log = "night.lcm";
    write_recorded_night(options_.log, 12.0, false);
    options_.size = {480, 360};
    options_.quality = QualityWish::kLow;
    options_.hud = false;
    auto source = ReplaySource::open(options_);
    ASSERT_TRUE(source) << source.error().what;
    source_ = std::move(*source);
    auto run = WindowRun::create(options_, *source_);
    if (!run) GTEST_SKIP() << run.error().what;
    run_ = std::move(*run);
    keep_drivers_loaded();
    for (int i = 0; i < 3000 && source_->player() == nullptr; ++i) turn(1);
    ASSERT_NE(source_->player(), nullptr) << source_->note();
    source_->player()->set_playing(false);
    source_->player()->go_to(source_->player()->index().begin + Duration::s(3));
  }
  void TearDown() override {
    run_.reset();
    if (!before_.empty()) std::filesystem::current_path(before_);
  }
  void turn(int times) {
    for (int i = 0; i < times; ++i) {
      const auto turned = run_->turn();
      ASSERT_TRUE(turned) << turned.error().what;
    }
  }
  void press(int key) { run_->input().on_key({key}); }
  std::size_t exports() const {
    std::size_t count = 0;
    for (const auto& file : std::filesystem::directory_iterator("."))
      count += file.path().string().find("night-") != std::string::npos ? 1 : 0;
    return count;
  }

  VirtualDisplay display_;
  TestFolder folder_{"window-log"};
  std::filesystem::path before_;
  ViewOptions options_;
  std::unique_ptr<ReplaySource> source_;
  std::unique_ptr<WindowRun> run_;
};

TEST_F(WindowLogTest, SignsStepFramesAndSetTheLoop) {
  ReplayPlayer& player = *source_->player();
  const MonoTime at = player.position();
  press(press_of_letter('.', false)->key);
  EXPECT_GT(player.position(), at);
  press(press_of_letter(',', false)->key);
  EXPECT_EQ(player.position(), at);
  press(press_of_letter('[', false)->key);
  EXPECT_EQ(player.loop_begin(), at);
  press(GLFW_KEY_RIGHT);
  press(press_of_letter(']', false)->key);
  EXPECT_EQ(player.loop_end(), at + Duration::s(5));
}

TEST_F(WindowLogTest, AsksBeforeAnExportIsGivenUp) {
  turn(1);
  for (const int closing : {GLFW_KEY_ESCAPE, GLFW_KEY_Q}) {
    press(GLFW_KEY_E);
    press(GLFW_KEY_2);  // pictures
    turn(1);
    ASSERT_EQ(exports(), 1u);
    press(closing);
    EXPECT_FALSE(run_->is_over());
    turn(1);
    EXPECT_EQ(exports(), 1u) << "only asked";
    press(GLFW_KEY_E);  // go on
    press(closing);
    press(GLFW_KEY_Q);
    EXPECT_FALSE(run_->is_over()) << "Q does not answer";
    EXPECT_EQ(exports(), 1u);
    press(GLFW_KEY_ESCAPE);
    EXPECT_FALSE(run_->is_over());
    EXPECT_EQ(exports(), 0u) << "cancelled, as it was asked";
  }
  press(GLFW_KEY_Q);
  EXPECT_TRUE(run_->is_over());
}

TEST_F(WindowLogTest, AnExportThatHasEndedIsNotAskedAbout) {
  ReplayPlayer& player = *source_->player();
  player.set_loop_begin();
  player.go_to(player.position() + Duration::ms(100));
  player.set_loop_end();
  press(GLFW_KEY_E);
  press(GLFW_KEY_3);  // GLB
  press(GLFW_KEY_Q);
  for (int i = 0; i < 300; ++i) turn(1);
  EXPECT_EQ(exports(), 1u);
  press(GLFW_KEY_ESCAPE);
  EXPECT_TRUE(run_->is_over());
  EXPECT_EQ(exports(), 1u) << "it stays";
}

}  // namespace
}  // namespace dance
