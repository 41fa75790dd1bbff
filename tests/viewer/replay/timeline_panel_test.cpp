// The keys of the timeline, on a recording that is open.
#include "viewer/replay/timeline/timeline_panel.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "tests/test_folder.h"
#include "viewer/program/view_options.h"

namespace dance {
namespace {

class TimelinePanelTest : public ::testing::Test {
 protected:
  TimelinePanelTest() {
    std::filesystem::copy_file(std::string(DANCE_SOURCE_DIR) + "/logs/couple-packed.lcm",
                               options_.log);
    options_.headless = true;
    auto source = ReplaySource::open(options_);
    EXPECT_TRUE(source) << source.error().what;
    source_ = std::move(*source);
    TimelinePanel::Exporting exporting;
    exporting.start = [this](ExportKind kind) { started_.push_back(kind); };
    exporting.cancel = [this] { ++cancelled_; };
    exporting.is_running = [this] { return is_running_; };
    panel_ = std::make_unique<TimelinePanel>(*source_, exporting);
  }
  bool press(int key, bool has_shift = false, bool has_control = false, bool is_repeat = false) {
    return panel_->on_key({key, is_repeat, has_shift, has_control});
  }
  ReplayPlayer& player() { return *source_->player(); }

  TestFolder folder_{"timeline-panel"};
  static ViewOptions options_in(const std::string& log) {
    ViewOptions options;
    options.log = log;
    return options;
  }
  ViewOptions options_ = options_in(folder_.path("couple.lcm"));
  std::unique_ptr<ReplaySource> source_;
  std::unique_ptr<TimelinePanel> panel_;
  std::vector<ExportKind> started_;
  int cancelled_ = 0;
  bool is_running_ = false;
};

TEST_F(TimelinePanelTest, SpaceTogglesOnceHoweverLongItIsHeld) {
  const bool was_playing = player().is_playing();
  EXPECT_TRUE(press(GLFW_KEY_SPACE));
  EXPECT_NE(player().is_playing(), was_playing);
  EXPECT_TRUE(press(GLFW_KEY_SPACE, false, false, true));
  EXPECT_NE(player().is_playing(), was_playing);
}

TEST_F(TimelinePanelTest, ArrowsGoSecondsBeatsAndBars) {
  player().set_playing(false);
  EXPECT_TRUE(press(GLFW_KEY_RIGHT));
  EXPECT_NEAR(player().seconds(), 5.0, 1e-6);
  EXPECT_TRUE(press(GLFW_KEY_RIGHT, true));
  const double beat_s = player().seconds();
  EXPECT_GT(beat_s, 5.0);
  EXPECT_LT(beat_s, 5.4);  // at 180 beats a minute
  EXPECT_TRUE(press(GLFW_KEY_RIGHT, true));
  EXPECT_NEAR(player().seconds() - beat_s, 1.0 / 3.0, 0.02);
  EXPECT_TRUE(press(GLFW_KEY_RIGHT, false, true));
  const double bar_s = player().seconds();
  EXPECT_TRUE(press(GLFW_KEY_RIGHT, false, true));
  EXPECT_NEAR(player().seconds() - bar_s, 4.0 / 3.0, 0.02);
  EXPECT_TRUE(press(GLFW_KEY_LEFT, false, true));
  EXPECT_NEAR(player().seconds(), bar_s, 1e-6);
  EXPECT_TRUE(press(GLFW_KEY_LEFT));
  EXPECT_NEAR(player().seconds(), bar_s - 5.0, 1e-6);
}

TEST_F(TimelinePanelTest, FramesEndsAndSpeedHaveTheirKeys) {
  EXPECT_TRUE(press(GLFW_KEY_HOME));
  EXPECT_TRUE(press(GLFW_KEY_PERIOD));
  EXPECT_NEAR(player().seconds(), 1.0 / 60.0, 1e-3);
  EXPECT_FALSE(player().is_playing());
  EXPECT_TRUE(press(GLFW_KEY_COMMA));
  EXPECT_NEAR(player().seconds(), 0.0, 1e-6);
  EXPECT_TRUE(press(GLFW_KEY_END));
  EXPECT_EQ(player().position(), player().index().end);
  EXPECT_TRUE(press(GLFW_KEY_DOWN));
  EXPECT_EQ(player().speed(), 0.75);
  for (int i = 0; i < 20; ++i) EXPECT_TRUE(press(GLFW_KEY_DOWN, false, false, true));
  EXPECT_EQ(player().speed(), ReplayPlayer::kSlowest);
  for (int i = 0; i < 20; ++i) EXPECT_TRUE(press(GLFW_KEY_UP, false, false, true));
  EXPECT_EQ(player().speed(), ReplayPlayer::kFastest);
}

TEST_F(TimelinePanelTest, BracketsSetTheLoopAndLTurnsItOnAndOff) {
  player().go_to(player().index().begin + Duration::s(2));
  EXPECT_TRUE(press(GLFW_KEY_LEFT_BRACKET));
  player().go_to(player().index().begin + Duration::s(4));
  EXPECT_TRUE(press(GLFW_KEY_RIGHT_BRACKET));
  EXPECT_TRUE(player().loops());
  EXPECT_NEAR((player().range_end() - player().range_begin()).as_seconds(), 2.0, 1e-9);
  EXPECT_TRUE(press(GLFW_KEY_L));
  EXPECT_FALSE(player().loops());
  EXPECT_TRUE(player().loop_begin().has_value());
  EXPECT_TRUE(press(GLFW_KEY_L, true));
  EXPECT_FALSE(player().loop_begin().has_value());
}

TEST_F(TimelinePanelTest, EAsksWhatToExportAndANumberAnswers) {
  EXPECT_FALSE(press(GLFW_KEY_2));  // a dancer's, not the timeline's
  EXPECT_TRUE(press(GLFW_KEY_E));
  EXPECT_TRUE(press(GLFW_KEY_1));
  EXPECT_EQ(started_, std::vector{ExportKind::kVideo}) << "the kinds for dancers come first";
  EXPECT_FALSE(press(GLFW_KEY_2));
  EXPECT_TRUE(press(GLFW_KEY_E));
  EXPECT_TRUE(press(GLFW_KEY_4));
  EXPECT_EQ(started_.back(), ExportKind::kBvh);
  EXPECT_TRUE(press(GLFW_KEY_E));
  EXPECT_TRUE(press(GLFW_KEY_E));  // asks no more
  EXPECT_FALSE(press(GLFW_KEY_1));
}

TEST_F(TimelinePanelTest, EscapeInTheMenuCancelsTheExportThatRuns) {
  is_running_ = true;
  EXPECT_TRUE(press(GLFW_KEY_E));
  EXPECT_TRUE(press(GLFW_KEY_1));  // one at a time
  EXPECT_TRUE(started_.empty());
  EXPECT_TRUE(press(GLFW_KEY_E));
  EXPECT_TRUE(press(GLFW_KEY_ESCAPE));
  EXPECT_EQ(cancelled_, 1);
  is_running_ = false;
  EXPECT_FALSE(press(GLFW_KEY_ESCAPE));  // the window's again
}

TEST_F(TimelinePanelTest, OtherKeysAreOthers) {
  for (const int key : {GLFW_KEY_A, GLFW_KEY_V, GLFW_KEY_I, GLFW_KEY_TAB, GLFW_KEY_SLASH})
    EXPECT_FALSE(press(key)) << key;
}

TEST_F(TimelinePanelTest, WithoutExportsEIsNotItsKey) {
  TimelinePanel bare(*source_);
  EXPECT_FALSE(bare.on_key({GLFW_KEY_E, false, false, false}));
}

}  // namespace
}  // namespace dance
