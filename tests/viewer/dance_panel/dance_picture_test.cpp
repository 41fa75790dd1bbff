// The dance panel, drawn and worked with: mouse alone, keyboard alone, long names, thirty guests,
// three languages, two scales. DANCE_PICTURES names a folder where the pictures are to be kept.
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <gtest/gtest.h>
#include <imgui.h>

#include <cstdlib>

#include "tests/test_folder.h"
#include "tests/viewer/dressed_scene.h"
#include "tests/viewer/driver_memory.h"
#include "tests/viewer/instruments/synthetic_line.h"
#include "tests/viewer/test_scene.h"
#include "viewer/dance_panel/dance_panel.h"
#include "viewer/gl/offscreen.h"
#include "viewer/panel/panel_stack.h"
#include "viewer/stage/stage_painter.h"

namespace dance {
namespace {

constexpr double kBegin_ms = 900'000.0;
constexpr int kWidth_px = 1280, kHeight_px = 720;

// How the line of a guest is.
struct Line {
  std::string name;
  bool is_remote = true;
  int lost_of_ten = 0;
  double late_ms = 40.0;
  bool is_silent = false;
};

class DancePictureTest : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    auto made = OffscreenContext::create();
    if (!made) {
      why_not_ = made.error().what;
      return;
    }
    context_ = std::move(*made);
    keep_drivers_loaded();
  }
  static void TearDownTestSuite() { context_.reset(); }
  void SetUp() override {
    if (!context_) GTEST_SKIP() << why_not_;
  }

  void begin(Language language, int width_px, int height_px, float scale) {
    width_px_ = width_px;
    height_px_ = height_px;
    DanceNeeds needs{board_, figures_, wishes_, drawing_, language,
                     {folder_.path("dance-record"), folder_.path("videos"), ""}, {}, {}};
    needs.tell_voice = [this](const GuestId& guest, std::string_view command) -> Result<void> {
      told_.push_back(std::string(guest.view()) + ": " + std::string(command));
      return {};
    };
    auto panel = std::make_unique<DancePanel>(std::move(needs));
    panel_ = panel.get();
    panels_.add(std::move(panel));
    auto painter = StagePainter::create(Quality::kLow, scale);
    ASSERT_TRUE(painter) << painter.error().what;
    painter_ = std::move(*painter);
    ImGui::GetIO().MousePos = {-1e6f, -1e6f};
    scene_ = dressed(couple());
    scene_.guests[1].voice = 0.7f;
    scene_.music = SceneMusic{33.2, 98.0 / 60.0, 4};
    scene_.voices.push_back({guest_called("alice"), false, false, true, false, true});
    Music music;
    EXPECT_TRUE(music.title.assign("Quimbara - Celia Cruz & Johnny Pacheco (live, long version)"));
    board_.on_music(music);
    HouseLink link;
    link.state = HouseLinkState::kConnected;
    link.may_remove = true;
    link_ = link;
    tell_of({{"alice", false}, {"bob"}});
  }

  // Some seconds of these guests, as bus and instruments hear them.
  void tell_of(const std::vector<Line>& lines) {
    lines_ = lines;
    for (int second = 0; second < 8; ++second) {
      const auto sequence = static_cast<std::uint32_t>(now_.since_zero_us() / 1'000'000 * 60);
      for (const Line& line : lines) {
        const GuestId id = guest_called(line.name);
        for (std::uint32_t i = 0; i < 60 && !(line.is_silent && second > 2); ++i) {
          if (static_cast<int>(i % 10) < line.lost_of_ten) continue;
          const MonoTime captured = now_ + Duration::ms(16) * static_cast<int>(i);
          const MonoTime heard = captured + Duration::seconds(1e-3 * line.late_ms);
          Pose pose = dance_at(captured, sequence + i);
          pose.stamp(Hop::kLinkReceived, heard);
          instruments_.on_pose(line.is_remote ? Where::kGuest : Where::kCapture, id, pose, heard);
          instruments_.on_shown(id, shown_at(pose, heard, heard + Duration::ms(8)));
        }
        tell_status(line, line.is_silent && second > 2);
      }
      now_ += Duration::s(1);
      instruments_.end_seconds(now_, [](const GuestId&, const GuestStats&) {});
      figures_.take(instruments_);
      if (panel_ != nullptr) work();
    }
  }

  void tell_status(const Line& line, bool is_silent) {
    const GuestId id = guest_called(line.name);
    GuestStatus status;
    status.remote = line.is_remote;
    status.alive = true;
    status.received = is_silent ? 180 : now_.since_zero_us() / 10'000;
    board_.on_status(id, status, now_);
    if (line.is_remote) board_.on_traffic(id, now_);
  }

  void work() {
    if (link_) board_.on_link(*link_, now_);
    panel_->records().take(board_, now_);
    panel_->records().judge(figures_, scene_, now_);
  }

  void pass_time() {
    now_ += Duration::ms(16);
    scene_.time = now_;
    if (link_) board_.on_link(*link_, now_);
    board_.on_level(guest_called("alice"), {now_, 1, -22, -24}, now_);
    if (now_ - told_at_ < Duration::s(1)) return;
    told_at_ = now_;
    for (const Line& line : lines_) tell_status(line, line.is_silent);
  }
  // The panels of a picture, without the dancers: so that many of them cost little.
  void turn() {
    pass_time();
    OverlayChoice choice{false, false};
    choice.panels = &panels_;
    choice.whole = &scene_;
    painter_->overlay().draw_frames({}, width_px_, height_px_, choice);
  }
  Picture draw() {
    pass_time();
    OverlayChoice choice{true, false};
    choice.panels = &panels_;
    std::vector<Eigen::Vector3f> points;
    for (const SceneGuest& guest : scene_.guests) append_outline(guest, points);
    const OrbitCamera camera = frame_points(
        OrbitCamera(), points, static_cast<float>(width_px_) / static_cast<float>(height_px_),
        0.86f);
    const auto drawn = painter_->draw(scene_, camera, width_px_, height_px_, choice);
    EXPECT_TRUE(drawn) << drawn.error().what;
    return painter_->read();
  }
  Picture keep(const std::string& name) {
    const Picture picture = draw();
    const char* folder = std::getenv("DANCE_PICTURES");
    if (folder != nullptr) {
      EXPECT_TRUE(write_png(std::string(folder) + "/" + name + ".png", picture));
    }
    return picture;
  }

  bool press(int key, bool has_shift = false) {
    KeyPress pressed;
    pressed.key = key;
    pressed.has_shift = has_shift;
    const bool is_taken = panels_.on_key(pressed);
    turn();
    return is_taken;
  }
  void move(float x, float y) {
    ImGui::GetIO().MousePos = {x, y};
    turn();
  }
  void click(float x, float y) {
    move(x, y);
    ImGui::GetIO().MouseDown[0] = true;
    turn();
    ImGui::GetIO().MouseDown[0] = false;
    turn();
  }
  // Down with the keyboard until something is so, as a person looks for a control.
  template <class Done>
  bool find_with_keys(Done done, int most = 200) {
    for (int i = 0; i < most; ++i) {
      press(GLFW_KEY_DOWN);
      press(GLFW_KEY_ENTER);
      if (done()) return true;
    }
    return false;
  }
  // A click on each place of a grid within the column, until something is so.
  template <class Done>
  bool find_with_mouse(Done done) {
    const float left = static_cast<float>(width_px_) - 305.0f;
    for (float y = 20.0f; y < static_cast<float>(height_px_) - 12.0f; y += 11.0f)
      for (float x = left; x < static_cast<float>(width_px_) - 15.0f; x += 34.0f) {
        if (!panel_->is_open()) panel_->open(true);
        click(x, y);
        if (done()) return true;
      }
    return false;
  }

  // Pixels that differ between two pictures, in a part of them.
  static int changed(const Picture& a, const Picture& b, int x_from, int x_to) {
    int count = 0;
    for (int y = 0; y < a.height_px; ++y)
      for (int x = x_from; x < x_to; ++x) count += a.at(x, y) != b.at(x, y) ? 1 : 0;
    return count;
  }

  TestFolder folder_{"dance-picture"};
  DanceBoard board_;
  InstrumentBoard instruments_{kHouseClock};
  InstrumentRecords figures_;
  DanceWishes wishes_;
  BannerWatch::Drawing drawing_;
  PanelStack panels_;
  DancePanel* panel_ = nullptr;
  std::unique_ptr<StagePainter> painter_;
  SceneState scene_;
  std::optional<HouseLink> link_;
  std::vector<std::string> told_;
  std::vector<Line> lines_;
  MonoTime now_ = at_ms(kBegin_ms), told_at_;
  int width_px_ = kWidth_px, height_px_ = kHeight_px;
  static inline std::unique_ptr<OffscreenContext> context_;
  static inline std::string why_not_;
};

std::vector<Line> all_sorts() {
  return {{"alice", false},
          {"bob", true, 1},
          {"carla", true, 0, 140.0},
          {"dora", true, 0, 40.0, true},
          {"emil"}};
}

TEST_F(DancePictureTest, EscOpensAndClosesItAndTheMiddleStaysFree) {
  begin(Language::kEnglish, kWidth_px, kHeight_px, 1.0f);
  const Picture closed = draw();
  EXPECT_TRUE(press(GLFW_KEY_ESCAPE));
  EXPECT_TRUE(panel_->is_open());
  const Picture open = keep("dance-couple");
  EXPECT_GT(changed(closed, open, 960, kWidth_px), 20'000);
  EXPECT_EQ(changed(closed, open, 0, 960), 0) << "three quarters of the picture are the dancers'";
  EXPECT_TRUE(press(GLFW_KEY_ESCAPE));
  EXPECT_FALSE(panel_->is_open());
}

TEST_F(DancePictureTest, AButtonInTheCornerOpensItWhereTheMouseMoves) {
  begin(Language::kEnglish, kWidth_px, kHeight_px, 1.0f);
  const Picture still = draw();
  EXPECT_EQ(changed(still, draw(), 1200, kWidth_px), 0);
  move(400.0f, 400.0f);
  move(410.0f, 400.0f);
  EXPECT_GT(changed(still, keep("dance-corner"), 1200, kWidth_px), 300);
  for (int i = 0; i < 4 * 62; ++i) turn();
  EXPECT_EQ(changed(still, draw(), 1200, kWidth_px), 0) << "and hides again";
  move(1250.0f, 24.0f);
  click(1250.0f, 24.0f);
  EXPECT_TRUE(panel_->is_open());
}

TEST_F(DancePictureTest, EverythingIsReachedWithTheKeyboardAlone) {
  begin(Language::kEnglish, kWidth_px, kHeight_px, 1.0f);
  tell_of(all_sorts());
  press(GLFW_KEY_ESCAPE);
  EXPECT_FALSE(press(GLFW_KEY_B)) << "talking is the window's";
  EXPECT_TRUE(find_with_keys([&] { return wishes_.mute_presses > 0; }));
  EXPECT_TRUE(find_with_keys([&] { return wishes_.deafen_presses > 0; }));
  EXPECT_TRUE(find_with_keys([&] { return !wishes_.hidden.empty(); }));
  EXPECT_TRUE(find_with_keys([&] { return !told_.empty(); }));
  EXPECT_TRUE(find_with_keys([&] { return wishes_.leaves; }));
}

TEST_F(DancePictureTest, RemovingAsksBackAndASecondEnterRemovesNobody) {
  begin(Language::kEnglish, kWidth_px, kHeight_px, 1.0f);
  panel_->open(true);
  panel_->choose(guest_called("bob"));
  turn();
  // Count in, microphone, loudspeaker, alice, bob; of bob: mute, hide, remove.
  const auto press_remove = [&] {
    for (int i = 0; i < 8; ++i) press(GLFW_KEY_DOWN);
    press(GLFW_KEY_ENTER);
    turn();
  };
  press_remove();
  keep("dance-remove");
  press(GLFW_KEY_ENTER);
  turn();
  EXPECT_FALSE(board_.take_asked());
  panel_->open(false);
  panel_->open(true);
  turn();
  press_remove();
  press(GLFW_KEY_UP);
  press(GLFW_KEY_ENTER);
  turn();
  const auto asked = board_.take_asked();
  ASSERT_TRUE(asked);
  EXPECT_EQ(asked->guest, guest_called("bob"));
}

TEST_F(DancePictureTest, OnlyAHostHasAButtonThatRemoves) {
  begin(Language::kEnglish, kWidth_px, kHeight_px, 1.0f);
  panel_->open(true);
  panel_->choose(guest_called("bob"));
  turn();
  const Picture host = draw();
  link_->may_remove = false;
  turn();
  EXPECT_GT(changed(host, draw(), 960, kWidth_px), 300);
}

TEST_F(DancePictureTest, EverythingIsReachedWithTheMouseAlone) {
  begin(Language::kEnglish, kWidth_px, kHeight_px, 1.0f);
  tell_of({{"alice", false}, {"bob"}});
  EXPECT_TRUE(find_with_mouse([&] { return wishes_.mute_presses > 0; }));
  EXPECT_TRUE(find_with_mouse([&] { return wishes_.deafen_presses > 0; }));
  EXPECT_TRUE(find_with_mouse([&] { return wishes_.leaves; }));
  panel_->choose(guest_called("bob"));
  EXPECT_TRUE(find_with_mouse([&] {
    panel_->choose(guest_called("bob"));
    return !told_.empty();
  }));
  EXPECT_TRUE(find_with_mouse([&] {
    panel_->choose(guest_called("bob"));
    return !wishes_.hidden.empty();
  }));
}

TEST_F(DancePictureTest, ArrowsChangeTheVolumeOfTheChosenGuest) {
  begin(Language::kEnglish, kWidth_px, kHeight_px, 1.0f);
  panel_->open(true);
  panel_->choose(guest_called("bob"));
  draw();
  for (int i = 0; i < 40 && told_.empty(); ++i) {
    press(GLFW_KEY_DOWN);
    press(GLFW_KEY_LEFT);
  }
  ASSERT_EQ(told_, std::vector<std::string>{"alice: volume bob=0.90"});
  press(GLFW_KEY_RIGHT);
  press(GLFW_KEY_RIGHT);
  EXPECT_EQ(told_.back(), "alice: volume bob=1.10");
}

TEST_F(DancePictureTest, VolumesAreToldAgainToAVoiceThatBeginsAnew) {
  begin(Language::kEnglish, kWidth_px, kHeight_px, 1.0f);
  panel_->records().choice_of(guest_called("bob")).is_voice_muted = true;
  draw();
  const auto voices = scene_.voices;
  told_.clear();
  scene_.voices.clear();
  draw();
  scene_.voices = voices;
  draw();
  draw();
  EXPECT_EQ(told_, std::vector<std::string>{"alice: volume bob=0.00"});
}

TEST_F(DancePictureTest, LooksFineWithTroubleInThreeLanguages) {
  for (const LanguageName& language : kLanguages) {
    panels_ = PanelStack();
    painter_.reset();
    begin(language.language, kWidth_px, kHeight_px, 1.0f);
    tell_of(all_sorts());
    panel_->open(true);
    panel_->choose(guest_called("bob"));
    link_->state = HouseLinkState::kLapsed;
    for (int i = 0; i < 260; ++i) turn();
    const Picture picture = keep("dance-trouble-" + std::string(language.code));
    EXPECT_GT(picture.rgb.size(), 0u);
    link_->state = HouseLinkState::kConnected;
  }
}

TEST_F(DancePictureTest, ThirtyGuestsWithLongNamesScrollAndTheKeyboardReachesTheLast) {
  for (const float scale : {1.0f, 2.0f}) {
    panels_ = PanelStack();
    painter_.reset();
    begin(Language::kGerman, static_cast<int>(scale * kWidth_px),
          static_cast<int>(scale * kHeight_px), scale);
    std::vector<Line> lines{{"alice", false}};
    for (int i = 0; i < 30; ++i)
      lines.push_back({"mmmmwwww-dancer-from-" + std::to_string(100 + i), true, i % 7 == 3 ? 1 : 0,
                       i % 5 == 2 ? 150.0 : 40.0});
    tell_of(lines);
    panel_->open(true);
    keep("dance-thirty-" + std::to_string(static_cast<int>(scale)));
    panel_->choose(guest_called("mmmmwwww-dancer-from-129"));
    press(GLFW_KEY_UP);  // from the end: leave, record, and the last guest's controls
    for (int i = 0; i < 2; ++i) press(GLFW_KEY_UP);
    keep("dance-thirty-last-" + std::to_string(static_cast<int>(scale)));
    told_.clear();
    for (int i = 0; i < 8 && told_.empty(); ++i) {
      press(GLFW_KEY_RIGHT);
      press(GLFW_KEY_UP);
    }
    ASSERT_FALSE(told_.empty());
    EXPECT_EQ(told_.back(), "alice: volume mmmmwwww-dancer-from-129=1.10");
  }
}

TEST_F(DancePictureTest, CountsInAboveTheDancers) {
  begin(Language::kEnglish, kWidth_px, kHeight_px, 1.0f);
  panel_->open(true);
  draw();
  const Picture before = draw();
  scene_.music->beats = 33.2;
  ASSERT_TRUE(find_with_keys([&] {
    scene_.music->beats = 36.1;
    const Picture picture = draw();
    const bool is_there = changed(before, picture, 500, 780) > 1500;
    scene_.music->beats = 33.2;
    draw();
    return is_there;
  }));
  scene_.music->beats = 38.05;
  keep("dance-count-in");
}

TEST_F(DancePictureTest, ARecordingThatCannotBeginIsABanner) {
  begin(Language::kEnglish, kWidth_px, kHeight_px, 1.0f);
  panel_->open(true);
  EXPECT_TRUE(find_with_keys([&] { return !panel_->recording().trouble().empty(); }));
  const Picture picture = keep("dance-no-recording");
  panel_->open(false);
  const Picture closed = draw();
  EXPECT_GT(changed(closed, picture, 0, 900), 500) << "the banner moves with the column";
}

}  // namespace
}  // namespace dance
