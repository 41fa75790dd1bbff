// What keys mean: on the person's own keyboard, to the panel that was opened last, and in the list
// of keys.

#define GLFW_INCLUDE_NONE
#include "viewer/window/window_keys.h"

#include <GLFW/glfw3.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "tests/viewer/driver_memory.h"
#include "tests/virtual_display.h"
#include "viewer/instruments/instrument_panel.h"
#include "viewer/style_panel/style_panel.h"
#include "viewer/window/help_panel.h"
#include "viewer/window/printed_keys.h"
#include "viewer/window/view_window.h"
#include "viewer/window/window_input.h"

namespace dance {
namespace {

int key_of(const RawKey& raw) {
  const auto press = press_of_key(raw);
  return press ? press->key : 0;
}

TEST(PrintedKeys, LettersAreKnownByWhatTheKeyBears) {
  EXPECT_EQ(key_of({GLFW_KEY_Q, "a"}), GLFW_KEY_A) << "French";
  EXPECT_EQ(key_of({GLFW_KEY_SEMICOLON, "m"}), GLFW_KEY_M) << "French";
  EXPECT_EQ(key_of({GLFW_KEY_I, "ı"}), GLFW_KEY_I) << "Turkish";
  EXPECT_EQ(key_of({GLFW_KEY_Q, "й"}), GLFW_KEY_Q) << "Russian";
  EXPECT_EQ(key_of({GLFW_KEY_1, "&"}), GLFW_KEY_1) << "French digits are printed with shift";
  EXPECT_EQ(key_of({GLFW_KEY_SPACE, nullptr}), GLFW_KEY_SPACE);
  EXPECT_EQ(key_of({GLFW_KEY_LEFT, nullptr}), GLFW_KEY_LEFT);
}

TEST(PrintedKeys, SignsAreTakenByTheCharacterThatIsTyped) {
  EXPECT_EQ(press_of_letter('[', false)->key, GLFW_KEY_LEFT_BRACKET);
  EXPECT_EQ(press_of_letter(']', false)->key, GLFW_KEY_RIGHT_BRACKET);
  EXPECT_EQ(press_of_letter(',', false)->key, GLFW_KEY_COMMA);
  EXPECT_EQ(press_of_letter('.', true)->key, GLFW_KEY_PERIOD);
  EXPECT_TRUE(press_of_letter('.', true)->is_repeat);
  EXPECT_EQ(press_of_letter('?', false)->key, GLFW_KEY_F1);
  for (const unsigned int other : {unsigned{'q'}, unsigned{'8'}, unsigned{'{'}, 0x20acu, 0u})
    EXPECT_FALSE(press_of_letter(other, false)) << other;
  // The key alone is not counted a second time, and does not count where it prints another sign.
  for (const RawKey& raw :
       {RawKey{GLFW_KEY_LEFT_BRACKET, "["}, RawKey{GLFW_KEY_PERIOD, "."},
        RawKey{GLFW_KEY_M, ","},                 // French
        RawKey{GLFW_KEY_LEFT_BRACKET, "ü"},      // German
        RawKey{GLFW_KEY_LEFT_BRACKET, nullptr},  // Spanish: an accent that waits for its letter
        RawKey{GLFW_KEY_RIGHT_BRACKET, nullptr}})
    EXPECT_EQ(key_of(raw), 0) << raw.key << (raw.printed != nullptr ? raw.printed : "");
  EXPECT_EQ(key_of({GLFW_KEY_RIGHT_BRACKET, "+"}), '+') << "German";
  EXPECT_EQ(key_of({GLFW_KEY_LEFT_BRACKET, "х"}), GLFW_KEY_LEFT_BRACKET) << "no [ in Russian";
}

TEST(PrintedKeys, DigitsWithAltGrAreSignsAndChooseNobody) {
  for (int key = GLFW_KEY_1; key <= GLFW_KEY_9; ++key) {
    const RawKey plain{key, nullptr};
    ASSERT_TRUE(press_of_key(plain));
    EXPECT_EQ(window_command(*press_of_key(plain))->action, WindowAction::kChooseNumber);
    EXPECT_FALSE(press_of_key({key, nullptr, false, 0, true})) << "as X11 tells it";
    EXPECT_FALSE(press_of_key({key, nullptr, false, GLFW_MOD_CONTROL | GLFW_MOD_ALT, false}))
        << "as Windows tells it";
  }
  EXPECT_FALSE(press_of_key({GLFW_KEY_E, "e", false, 0, true})) << "the euro";
}

class HeardKeys final : public WindowEvents {
 public:
  void on_key(const KeyPress& press) override { keys.push_back(press.key); }
  void on_drag(WindowDrag, float, float) override {}
  void on_wheel(float) override {}
  void on_key_released(const KeyPress& press) override { released.push_back(press.key); }
  std::vector<int> keys, released;
};

TEST(PrintedKeys, AWindowHearsABracketOnceWhereverItLies) {
  const VirtualDisplay display;
  if (display.display().empty()) GTEST_SKIP() << kNoVirtualDisplay;
  setenv("DISPLAY", display.display().c_str(), 1);
  HeardKeys heard;
  const auto window = ViewWindow::create({200, 150}, heard);
  if (!window) GTEST_SKIP() << window.error().what;
  keep_drivers_loaded();
  GLFWwindow* handle = (*window)->handle();
  const GLFWkeyfun on_key = glfwSetKeyCallback(handle, nullptr);
  const GLFWcharfun on_letter = glfwSetCharCallback(handle, nullptr);
  ASSERT_TRUE(on_key != nullptr && on_letter != nullptr);
  // American, as this display is: the key, then its character.
  const int scancode = glfwGetKeyScancode(GLFW_KEY_LEFT_BRACKET);
  on_key(handle, GLFW_KEY_LEFT_BRACKET, scancode, GLFW_PRESS, 0);
  on_letter(handle, '[');
  EXPECT_EQ(heard.keys, std::vector<int>{GLFW_KEY_LEFT_BRACKET});
  // German: AltGr and 8.
  heard.keys.clear();
  on_key(handle, GLFW_KEY_8, glfwGetKeyScancode(GLFW_KEY_8), GLFW_PRESS, GLFW_MOD_ALT);
  on_letter(handle, '[');
  EXPECT_EQ(heard.keys, std::vector<int>{GLFW_KEY_LEFT_BRACKET});
}

TEST(PrintedKeys, AWindowTellsThatAKeyIsLetGoWhateverIsHeldWithIt) {
  const VirtualDisplay display;
  if (display.display().empty()) GTEST_SKIP() << kNoVirtualDisplay;
  setenv("DISPLAY", display.display().c_str(), 1);
  HeardKeys heard;
  const auto window = ViewWindow::create({200, 150}, heard);
  if (!window) GTEST_SKIP() << window.error().what;
  keep_drivers_loaded();
  GLFWwindow* handle = (*window)->handle();
  const GLFWkeyfun on_key = glfwSetKeyCallback(handle, nullptr);
  const int scancode = glfwGetKeyScancode(GLFW_KEY_B);
  on_key(handle, GLFW_KEY_B, scancode, GLFW_PRESS, 0);
  on_key(handle, GLFW_KEY_B, scancode, GLFW_REPEAT, 0);
  EXPECT_TRUE(heard.released.empty());
  on_key(handle, GLFW_KEY_B, scancode, GLFW_RELEASE, GLFW_MOD_CONTROL | GLFW_MOD_ALT);
  EXPECT_EQ(heard.released, std::vector<int>{GLFW_KEY_B});
  EXPECT_EQ(heard.keys, (std::vector<int>{GLFW_KEY_B, GLFW_KEY_B})) << "no key goes down";
}

TEST(WindowInput, TalksWhileItsKeyIsHeldWithAPanelOpenedMeanwhile) {
  WindowState state;
  ViewDirector director(CameraPreset::kAuto, ViewMode::kOrbit);
  PanelStack panels;
  WindowInput input(state, director, panels);
  input.on_key({GLFW_KEY_B});
  input.on_key({GLFW_KEY_B, true});
  EXPECT_TRUE(state.voice.is_talk_held);
  auto help = std::make_unique<HelpPanel>(panels, window_key_groups(false));
  help->open();
  panels.add(std::move(help));
  input.on_key_released({GLFW_KEY_B, false, false, true});
  EXPECT_FALSE(state.voice.is_talk_held);
  input.on_key({GLFW_KEY_U});
  input.on_key({GLFW_KEY_U, true});
  input.on_key({GLFW_KEY_J});
  EXPECT_EQ(state.voice.mute_presses, 1) << "a key that repeats mutes once";
  EXPECT_EQ(state.voice.deafen_presses, 1);
}

TEST(WindowInput, GoesThroughThePlacesBothWays) {
  WindowState state;
  ViewDirector director(CameraPreset::kAuto, ViewMode::kOrbit);
  PanelStack panels;
  WindowInput input(state, director, panels);
  EXPECT_EQ(state.place, Venue::kStudio);
  input.on_key({GLFW_KEY_Z});
  EXPECT_EQ(state.place, Venue::kBar);
  input.on_key({GLFW_KEY_Z, false, true});
  EXPECT_EQ(state.place, Venue::kStudio);
  EXPECT_EQ(state.place_changes, 2) << "one for each key press";
}

// The panels of a live window.
class PanelKeys : public testing::Test {
 protected:
  PanelKeys() {
    for (const char* name : {"alice", "bob", "carla"})
      board_.on_flow(*GuestId::parse(name), FlowSetting());
    records_.take(board_);
    add(instruments_, std::make_unique<InstrumentPanel>(records_));
    add(style_, std::make_unique<StylePanel>(records_, board_, nullptr, true));
    add(help_, std::make_unique<HelpPanel>(panels_, window_key_groups(false)));
  }
  template <typename Panel>
  void add(Panel*& panel, std::unique_ptr<Panel> made) {
    panel = made.get();
    panels_.add(std::move(made));
  }
  bool press(int key) { return panels_.on_key({key}); }

  InstrumentBoard board_{1};
  InstrumentRecords records_;
  PanelStack panels_;
  InstrumentPanel* instruments_ = nullptr;
  StylePanel* style_ = nullptr;
  HelpPanel* help_ = nullptr;
};

TEST_F(PanelKeys, EscClosesThePanelOpenedLastAndThenTheOneBefore) {
  for (const auto& [first, second] :
       {std::pair{GLFW_KEY_I, GLFW_KEY_S}, std::pair{GLFW_KEY_S, GLFW_KEY_I}}) {
    EXPECT_TRUE(press(first));
    EXPECT_TRUE(press(second));
    EXPECT_TRUE(press(GLFW_KEY_F1));
    EXPECT_TRUE(press(GLFW_KEY_ESCAPE));
    EXPECT_FALSE(help_->is_open());
    EXPECT_TRUE(instruments_->is_open() && style_->is_open());
    EXPECT_TRUE(press(GLFW_KEY_ESCAPE));
    EXPECT_EQ(instruments_->is_open(), first == GLFW_KEY_I);
    EXPECT_EQ(style_->is_open(), first == GLFW_KEY_S);
    EXPECT_TRUE(press(GLFW_KEY_ESCAPE));
    EXPECT_FALSE(instruments_->is_open() || style_->is_open());
    EXPECT_FALSE(press(GLFW_KEY_ESCAPE)) << "the window's";
  }
}

TEST_F(PanelKeys, TabGoesToThePanelOpenedLast) {
  EXPECT_FALSE(press(GLFW_KEY_TAB)) << "the window's, to choose a dancer";
  press(GLFW_KEY_I);
  EXPECT_TRUE(press(GLFW_KEY_TAB));
  EXPECT_EQ(instruments_->chosen(), GuestId::parse("bob"));
  press(GLFW_KEY_S);
  EXPECT_TRUE(press(GLFW_KEY_TAB));
  EXPECT_EQ(style_->chosen()->guest(), GuestId::parse("bob"));
  EXPECT_EQ(instruments_->chosen(), GuestId::parse("bob")) << "stays";
  press(GLFW_KEY_S);
  EXPECT_TRUE(press(GLFW_KEY_TAB));
  EXPECT_EQ(instruments_->chosen(), GuestId::parse("carla")) << "has it again";
}

std::string words_of(const std::vector<PanelStack::Group>& groups) {
  const Texts texts(Language::kEnglish);
  std::string all;
  for (const PanelStack::Group& group : groups) {
    EXPECT_NE(group.title, Text::kCount);
    EXPECT_FALSE(group.keys.empty()) << texts[group.title];
    for (const KeyHelp& help : group.keys) {
      EXPECT_NE(help.what, Text::kCount);
      all += " " + std::string(help.key_in(texts)) + " ";
    }
  }
  return all;
}

TEST(HelpPanel, TellsEveryKeyThatDoesSomething) {
  for (const bool has_log : {false, true}) {
    const std::string all = words_of(window_key_groups(has_log));
    for (int key = GLFW_KEY_A; key <= GLFW_KEY_Z; ++key) {
      const bool does = window_command({key}).has_value();
      const std::string letter = std::string(" ") + static_cast<char>(key) + " ";
      EXPECT_EQ(does, all.find(letter) != std::string::npos) << letter;
    }
  }
}

TEST(HelpPanel, LeavesTheArrowsOfALogToItsTimeline) {
  const std::string live = words_of(window_key_groups(false));
  const std::string of_log = words_of(window_key_groups(true));
  for (const char* arrow : {"←", "→", "↑", "↓"}) {
    EXPECT_NE(live.find(arrow), std::string::npos) << arrow;
    EXPECT_EQ(of_log.find(arrow), std::string::npos) << arrow;
  }
  EXPECT_NE(of_log.find("Wheel"), std::string::npos) << "comes nearer as before";
}

}  // namespace
}  // namespace dance
