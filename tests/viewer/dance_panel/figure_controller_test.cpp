// Changing a figure by a program beside the window: what it is asked, what is kept, and what is
// said when it fails.
#include "viewer/dance_panel/own/figure_controller.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>
#include <thread>

#include "core/net/mono_clock.h"
#include "tests/test_folder.h"

namespace dance {
namespace {

class FigureControllerTest : public ::testing::Test {
 protected:
  // Writes its arguments into a file, one line for each start.
  void write_program(const std::string& more) {
    const std::string path = folder_.path("choose");
    std::ofstream(path) << "#!/bin/sh\necho \"$*\" >>'" << folder_.path("asked") << "'\n" << more;
    std::filesystem::permissions(path, std::filesystem::perms::owner_all);
  }
  FigureController open(const std::string& more) {
    write_program(more);
    FigureController::Needs needs;
    needs.program = folder_.path("choose");
    needs.bus = "memq://";
    needs.current = [](const GuestId&) {
      OwnFigure figure;
      figure.height = 1.25;
      return figure;
    };
    needs.keep = [this](const GuestId& guest, const OwnFigure& figure) -> Result<void> {
      if (cannot_keep_) return fail("the file is not ours");
      kept_.emplace_back(guest.view(), figure);
      return {};
    };
    return FigureController(std::move(needs));
  }
  static bool work_until_done(FigureController& desk) {
    const MonoTime end = mono_now() + Duration::s(60);
    while (desk.is_busy() && mono_now() < end) {
      desk.work();
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    return !desk.is_busy();
  }
  std::string asked() const {
    std::ostringstream text;
    text << std::ifstream(folder_.path("asked")).rdbuf();
    return text.str();
  }

  TestFolder folder_{"figure-desk"};
  std::vector<std::pair<std::string, OwnFigure>> kept_;
  bool cannot_keep_ = false;
  const GuestId alice_ = *GuestId::parse("alice");
};

TEST_F(FigureControllerTest, AsksTheHouseAndThenKeepsTheChoice) {
  FigureController desk = open("");
  OwnFigure figure;
  figure.what = "/my figures/me.vrm";
  desk.choose(alice_, figure);
  ASSERT_TRUE(work_until_done(desk));
  EXPECT_EQ(asked(), "choose alice /my figures/me.vrm --height=1.25 --bus=memq://\n");
  EXPECT_EQ(desk.trouble(), "");
  ASSERT_EQ(kept_.size(), 1u);
  EXPECT_EQ(kept_[0].first, "alice");
  EXPECT_EQ(kept_[0].second.what, figure.what);
  EXPECT_EQ(kept_[0].second.height, 1.25);
}

TEST_F(FigureControllerTest, OfChoicesMeanwhileTheLastCounts) {
  const std::string goes_on = folder_.path("goes-on");
  FigureController desk = open("while [ ! -e '" + goes_on + "' ]; do sleep 0.01; done\n");
  for (const char* name : {"teo", "tia", "ana"}) {
    OwnFigure figure;
    figure.what = name;
    desk.choose(alice_, figure);
  }
  std::ofstream(goes_on) << "now";
  ASSERT_TRUE(work_until_done(desk));
  ASSERT_EQ(kept_.size(), 2u);
  EXPECT_EQ(kept_[0].second.what, "teo");
  EXPECT_EQ(kept_[1].second.what, "ana");
}

TEST_F(FigureControllerTest, DrawsALookOfTheMannequinBySeed) {
  FigureController desk = open("");
  for (const std::uint64_t seed : {1u, 1u, 2u}) {
    desk.choose_any_look(alice_, seed);
    ASSERT_TRUE(work_until_done(desk));
  }
  ASSERT_EQ(kept_.size(), 3u);
  EXPECT_EQ(kept_[0].second, kept_[1].second);
  EXPECT_FALSE(kept_[0].second == kept_[2].second);
  EXPECT_NE(asked().find("choose alice mannequin --look="), std::string::npos) << asked();
}

TEST_F(FigureControllerTest, SaysInOneLineWhyAFigureIsRefusedAndKeepsNothing) {
  FigureController desk = open("echo 'first' >&2; printf 'no \\033[31m avatar\\n' >&2; exit 1\n");
  desk.choose(alice_, OwnFigure());
  ASSERT_TRUE(work_until_done(desk));
  EXPECT_TRUE(kept_.empty());
  EXPECT_TRUE(desk.trouble().starts_with("no ")) << desk.trouble();
  EXPECT_TRUE(desk.trouble().ends_with(" avatar"));
  EXPECT_EQ(desk.trouble().find('\033'), std::string::npos);
  write_program("");
  cannot_keep_ = true;
  desk.choose(alice_, OwnFigure());
  ASSERT_TRUE(work_until_done(desk));
  EXPECT_EQ(desk.trouble(), "the file is not ours");
}

}  // namespace
}  // namespace dance
