// A person changes a guest of this house in the dance panel, with mouse and keys.
#include <chrono>
#include <filesystem>
#include <fstream>
#include <thread>

#include "tests/viewer/dance_panel/dance_stage.h"

namespace dance {
namespace {

class OwnChoicesTest : public DanceStage {
 protected:
  void SetUp() override {
    DanceStage::SetUp();
    if (IsSkipped()) return;
    own_needs_.rename = [this](const GuestId& guest, const ShownName& name) {
      renamed_.emplace_back(guest.view(), name.view());
    };
    own_needs_.keep_name = [this](const GuestId& guest, std::string_view name) -> Result<void> {
      kept_.emplace_back(guest.view(), name);
      return {};
    };
    const std::string program = folder_.path("choose");
    std::ofstream(program) << "#!/bin/sh\necho \"$*\" >>'" << folder_.path("asked") << "'\n";
    std::filesystem::permissions(program, std::filesystem::perms::owner_all);
    own_needs_.figures.program = program;
    own_needs_.figures.list = [] {
      return std::vector<NamedFigure>{{"teo", "teo"}, {"/store/0123.vrm", ""}};
    };
    own_needs_.has_voice_switch = [](const GuestId& guest) { return guest.view() == "alice"; };
    own_needs_.switch_voice = [this](const GuestId& guest, bool is_on) -> Result<void> {
      switched_.emplace_back(guest.view(), is_on);
      return {};
    };
  }
  void open_own(Language language = Language::kEnglish) {
    begin(language, kWidth_px, kHeight_px, 1.0f);
    work();
    panel_->open(true);
    panel_->choose(guest_called("alice"));
    turn();
  }
  bool type(std::string_view text) {
    bool is_taken = true;
    for (const char c : text) is_taken = panels_.on_character(static_cast<char32_t>(c)) && is_taken;
    turn();
    return is_taken;
  }
  // Presses one control after the other until a line can be typed.
  bool open_line() {
    return find_with_keys([&] { return panels_.on_character(U'A'); });
  }
  // Waits until the choice is applied: a second one before that would replace it.
  bool has_asked(const std::string& what) {
    turn();
    for (int i = 0; panel_->own().changes_figure() && i < 30'000; ++i) {
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
      turn();
    }
    std::ifstream file(folder_.path("asked"));
    for (std::string line; std::getline(file, line);)
      if (line.starts_with("choose alice " + what)) return true;
    return false;
  }

  std::vector<std::pair<std::string, std::string>> renamed_, kept_;
  std::vector<std::pair<std::string, bool>> switched_;
};

TEST_F(OwnChoicesTest, RenamesAGuestOfThisHouseByATypedLine) {
  open_own();
  ASSERT_TRUE(open_line());
  renamed_.clear();
  kept_.clear();
  ASSERT_TRUE(type("na B"));
  keep("own-name");
  EXPECT_TRUE(press(GLFW_KEY_Q)) << "while a line is typed no key is the window's";
  EXPECT_TRUE(press(GLFW_KEY_ENTER));
  using Named = std::vector<std::pair<std::string, std::string>>;
  EXPECT_EQ(renamed_, (Named{{"alice", "Ana B"}}));
  EXPECT_EQ(kept_, renamed_);
  EXPECT_FALSE(type("x")) << "the line is closed";
  ASSERT_TRUE(open_line());
  EXPECT_TRUE(press(GLFW_KEY_ESCAPE));
  EXPECT_TRUE(panel_->is_open());
  EXPECT_FALSE(type("x"));
  EXPECT_EQ(renamed_.size(), 1u);
}

TEST_F(OwnChoicesTest, RefusesANameThatCannotBeShown) {
  open_own();
  ASSERT_TRUE(open_line());
  renamed_.clear();
  press(GLFW_KEY_BACKSPACE);
  type("  ");
  press(GLFW_KEY_ENTER);
  EXPECT_TRUE(type(std::string(41, 'x'))) << "the line stays";
  press(GLFW_KEY_ENTER);
  EXPECT_TRUE(renamed_.empty());
  keep("own-name-refused");
}

TEST_F(OwnChoicesTest, OffersTheFiguresOfThisMachine) {
  open_own();
  for (const char* what : {"mannequin", "mannequin --look=", "teo", "/store/0123.vrm"})
    EXPECT_TRUE(find_with_keys([&] { return has_asked(what); }, 600)) << what;
  keep("own-figures");
}

TEST_F(OwnChoicesTest, TurnsTheVoiceOnAndOff) {
  open_own();
  const auto has_switched = [&](bool is_on) {
    return std::ranges::find(switched_, std::pair<std::string, bool>("alice", is_on)) !=
           switched_.end();
  };
  EXPECT_TRUE(find_with_keys([&] { return has_switched(false); }));
  EXPECT_FALSE(has_switched(true));
  scene_.voices.clear();
  turn();
  keep("own-voice-off");
  EXPECT_TRUE(find_with_keys([&] { return has_switched(true); }));
}

TEST_F(OwnChoicesTest, OffersNothingForAGuestOfAnotherHouse) {
  open_own();
  panel_->choose(guest_called("bob"));
  EXPECT_FALSE(find_with_keys(
      [&] {
        panel_->choose(guest_called("bob"));
        return panels_.on_character(U'A') || has_asked("");
      },
      60));
  EXPECT_TRUE(renamed_.empty());
}

}  // namespace
}  // namespace dance
