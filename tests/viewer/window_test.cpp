// The window's way to pixels, under a virtual display of its own: what is on the screen is what a
// headless run writes.

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <memory>
#include <string>
#include <utility>

#include "core/base/printable.h"
#include "core/net/mono_clock.h"
#include "core/program/child_process.h"
#include "tests/viewer/board_source.h"
#include "tests/viewer/driver_memory.h"
#include "tests/viewer/test_scene.h"
#include "tests/virtual_display.h"
#include "viewer/gl/offscreen.h"
#include "viewer/stage/stage_painter.h"
#include "viewer/window/window_run.h"

namespace dance {
namespace {

constexpr int kWindowWidth_px = 480;
constexpr int kWindowHeight_px = 300;

class NoEvents final : public WindowEvents {
  void on_key(const KeyPress&) override {}
  void on_drag(WindowDrag, float, float) override {}
  void on_wheel(float) override {}
};

OrbitCamera camera_for(const SceneState& scene) {
  std::vector<Eigen::Vector3f> points;
  for (const SceneGuest& guest : scene.guests) append_outline(guest, points);
  return frame_points(OrbitCamera(), points, 1.6f, 0.86f);
}

double mean_difference(const Picture& a, const Picture& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.rgb.size(); ++i) sum += std::abs(a.rgb[i] - b.rgb[i]);
  return sum / static_cast<double>(a.rgb.size());
}

TEST(ViewWindow, NamesTheCureWhereThereIsNoDisplay) {
  unsetenv("DISPLAY");
  unsetenv("WAYLAND_DISPLAY");
  NoEvents events;
  const auto window = ViewWindow::create({kWindowWidth_px, kWindowHeight_px}, events);
  ASSERT_FALSE(window);
  EXPECT_NE(window.error().what.find("--headless"), std::string::npos);
}

bool says_what_to_do_without_opengl_33() {
  const VirtualDisplay display;
  if (display.display().empty()) return true;
  setenv("DISPLAY", display.display().c_str(), 1);
  setenv("MESA_GL_VERSION_OVERRIDE", "2.1", 1);
  NoEvents events;
  const auto window = ViewWindow::create({kWindowWidth_px, kWindowHeight_px}, events);
  return !window && window.error().what.find("3.3") != std::string::npos &&
         window.error().what.find("--headless") != std::string::npos &&
         printable(window.error().what) == window.error().what;
}

// In a process of its own: drivers read their settings once.
TEST(ViewWindow, NamesTheCureWhereTheDriverHasNoOpenGl33) {
  auto child = ChildProcess::start_copy([] { return says_what_to_do_without_opengl_33() ? 0 : 1; });
  ASSERT_TRUE(child) << child.error().what;
  ASSERT_TRUE(child->wait(Duration::s(60)));
  EXPECT_TRUE(child->ended_well()) << child->exit_text();
}

TEST(ViewWindow, ShowsThePixelsThatAFileWouldHold) {
  const SceneState scene = couple();
  const OrbitCamera camera = camera_for(scene);
  Picture headless;
  {
    auto context = OffscreenContext::create();
    if (!context) GTEST_SKIP() << context.error().what;
    keep_drivers_loaded();
    auto painter = StagePainter::create(Quality::kHigh, 1.0f);
    ASSERT_TRUE(painter) << painter.error().what;
    ASSERT_TRUE((*painter)->draw(scene, camera, kWindowWidth_px, kWindowHeight_px, {}));
    headless = (*painter)->read();
  }
  const VirtualDisplay display;
  if (display.display().empty()) GTEST_SKIP() << kNoVirtualDisplay;
  setenv("DISPLAY", display.display().c_str(), 1);
  NoEvents events;
  auto window = ViewWindow::create({kWindowWidth_px, kWindowHeight_px}, events);
  if (!window) GTEST_SKIP() << window.error().what;
  keep_drivers_loaded();
  ASSERT_EQ((*window)->framebuffer_size().width_px, kWindowWidth_px);
  auto painter = StagePainter::create(Quality::kHigh, 1.0f);
  ASSERT_TRUE(painter) << painter.error().what;
  ASSERT_TRUE((*painter)->draw(scene, camera, kWindowWidth_px, kWindowHeight_px, {}));
  (*painter)->present();
  glBindFramebuffer(GL_READ_FRAMEBUFFER, 0);
  const Picture shown = read_bound_framebuffer(kWindowWidth_px, kWindowHeight_px);
  (*window)->swap();
  EXPECT_EQ(glGetError(), static_cast<GLenum>(GL_NO_ERROR));
  ASSERT_EQ(shown.rgb.size(), headless.rgb.size());
  EXPECT_LT(mean_difference(shown, headless), 0.5);
  EXPECT_FALSE((*window)->is_over());
}

// The loop of the window, turn by turn.
class WindowRunTest : public testing::Test {
 protected:
  void SetUp() override {
    if (display_.display().empty()) GTEST_SKIP() << kNoVirtualDisplay;
    setenv("DISPLAY", display_.display().c_str(), 1);
    options_.size = {kWindowWidth_px, kWindowHeight_px};
    options_.camera = CameraPreset::kFront;
    options_.quality = quality();
    options_.hud = false;
    source_.put(couple());
    auto run = WindowRun::create(options_, source_);
    if (!run) GTEST_SKIP() << run.error().what;
    run_ = std::move(*run);
    keep_drivers_loaded();
  }
  virtual QualityWish quality() const { return QualityWish::kLow; }
  void turn(int times) {
    for (int i = 0; i < times; ++i) {
      source_.put(couple());
      const auto turned = run_->turn();
      ASSERT_TRUE(turned) << turned.error().what;
    }
    EXPECT_EQ(glGetError(), static_cast<GLenum>(GL_NO_ERROR));
  }
  // Figures are made in threads of their own, and the camera comes near softly: until the picture
  // stays.
  Picture settled() {
    SceneState scene = run_->scene();
    run_->avatars().wait_and_dress(scene);
    Picture last = shown();
    for (int i = 0; i < 60; ++i) {
      turn(10);
      Picture now = shown();
      const bool stays =
          mean_difference(last, now) < 0.1 && !run_->painter().renderer().is_waiting();
      last = std::move(now);
      if (stays && i > 2) break;
    }
    return last;
  }
  void press(int key, bool has_shift = false) {
    run_->input().on_key({key, false, has_shift, false});
  }
  // What the last picture was, before the swap made it undefined: drawn and presented once more.
  Picture shown() {
    const ViewWindow::Size size = run_->window().framebuffer_size();
    run_->painter().present();
    glBindFramebuffer(GL_READ_FRAMEBUFFER, 0);
    return read_bound_framebuffer(size.width_px, size.height_px);
  }

  VirtualDisplay display_;
  ViewOptions options_;
  BoardSource source_;
  std::unique_ptr<WindowRun> run_;
};

TEST_F(WindowRunTest, DrawsInAnotherSizeAsSoonAsTheWindowHasIt) {
  turn(2);
  for (const auto& [width, height] : {std::pair{600, 200}, std::pair{200, 500}}) {
    glfwSetWindowSize(run_->window().handle(), width, height);
    turn(8);  // the display server answers in its own time
    const ViewWindow::Size size = run_->window().framebuffer_size();
    EXPECT_EQ(size.width_px, width);
    EXPECT_EQ(size.height_px, height);
    const Picture picture = shown();
    // Drawn up to the corners: the backdrop is nowhere black.
    for (const auto& [x, y] : {std::pair{0, 0}, std::pair{width - 1, height - 1}}) {
      const auto at = static_cast<std::size_t>(3 * (y * width + x));
      EXPECT_GT(picture.rgb[at] + picture.rgb[at + 1] + picture.rgb[at + 2], 30);
    }
  }
}

// Keeps all pixels, however slow this machine is: pictures before and after are compared.
class WindowContextTest : public WindowRunTest {
 protected:
  QualityWish quality() const override { return QualityWish::kHigh; }
};

TEST_F(WindowContextTest, RecreatesEverythingWhenTheContextIsLost) {
  press(GLFW_KEY_H);
  press(GLFW_KEY_H);
  turn(4);
  const Picture before = settled();
  glfwSetWindowPos(run_->window().handle(), 60, 40);
  turn(2);
  for (int times = 1; times <= 3; ++times) {
    run_->window().lose_context();
    turn(4);
    EXPECT_EQ(run_->contexts_lost(), times);
  }
  EXPECT_FALSE(run_->window().is_context_lost());
  EXPECT_FALSE(run_->is_over()) << "the window stays";
  const ViewWindow::Size size = run_->window().framebuffer_size();
  EXPECT_EQ(size.width_px, kWindowWidth_px);
  EXPECT_EQ(size.height_px, kWindowHeight_px);
  const Picture after = settled();
  ASSERT_EQ(after.rgb.size(), before.rgb.size());
  EXPECT_LT(mean_difference(before, after), 1.0);
}

TEST_F(WindowRunTest, EndsWithWordsWhenTheDriverLosesEveryContext) {
  turn(1);
  bool has_ended = false;
  for (int i = 0; i < 40 && !has_ended; ++i) {
    run_->window().lose_context();
    const auto turned = run_->turn();
    has_ended = !turned;
    if (has_ended) {
      EXPECT_NE(turned.error().what.find("--headless"), std::string::npos);
    }
  }
  EXPECT_TRUE(has_ended);
}

TEST_F(WindowRunTest, KeysChooseViewsAndDancers) {
  turn(2);
  EXPECT_EQ(run_->director().mode(), ViewMode::kOrbit);
  press(GLFW_KEY_V);
  EXPECT_EQ(run_->director().mode(), ViewMode::kFollow);
  press(GLFW_KEY_V, true);
  EXPECT_EQ(run_->director().mode(), ViewMode::kOrbit);
  for (const auto& [key, mode] :
       {std::pair{GLFW_KEY_W, ViewMode::kFollow}, std::pair{GLFW_KEY_M, ViewMode::kMirror},
        std::pair{GLFW_KEY_P, ViewMode::kFirstPerson}, std::pair{GLFW_KEY_C, ViewMode::kCompare},
        std::pair{GLFW_KEY_G, ViewMode::kGrid}}) {
    press(key);
    EXPECT_EQ(run_->director().mode(), mode);
    turn(2);
  }
  press(GLFW_KEY_G);
  EXPECT_EQ(run_->director().mode(), ViewMode::kOrbit) << "the same key goes back";
  press(GLFW_KEY_2);
  turn(1);
  EXPECT_EQ(run_->director().chosen(), GuestId::parse("bob"));
  press(GLFW_KEY_RIGHT);
  turn(1);
  EXPECT_EQ(run_->director().chosen(), GuestId::parse("alice"));
  press(GLFW_KEY_9);  // there is no ninth
  turn(1);
  EXPECT_EQ(run_->director().chosen(), GuestId::parse("alice"));
  press(GLFW_KEY_F);
  EXPECT_FALSE(run_->director().chosen());
}

TEST_F(WindowRunTest, KeysChangeThePictureAndTheDisplay) {
  turn(1);
  press(GLFW_KEY_T);
  press(GLFW_KEY_X);
  press(GLFW_KEY_N);
  press(GLFW_KEY_D);
  turn(3);
  EXPECT_TRUE(run_->scene().shows_trails);
  EXPECT_FALSE(run_->state().extrapolates);
  EXPECT_FALSE(run_->state().shows_tags);
  EXPECT_EQ(run_->state().display, DisplayMode::kLowLatency);
  press(GLFW_KEY_D);
  turn(3);
  EXPECT_EQ(run_->state().display, DisplayMode::kTearFree);
  EXPECT_FALSE(run_->is_over());
  press(GLFW_KEY_Q);
  EXPECT_TRUE(run_->is_over());
}

TEST_F(WindowRunTest, TheListOfKeysIsShownAndClosedAndEscClosesItFirst) {
  turn(2);
  const Picture without = settled();
  press(GLFW_KEY_F1);
  turn(2);
  const Picture with = shown();
  EXPECT_GT(mean_difference(without, with), 5.0);
  press(GLFW_KEY_ESCAPE);
  turn(2);
  EXPECT_FALSE(run_->is_over());
  EXPECT_LT(mean_difference(without, shown()), 1.0);
  press(GLFW_KEY_ESCAPE);
  EXPECT_TRUE(run_->is_over());
}

// The path is told of a monitor's rate once, when the window is made: afterwards it looks.
TEST_F(WindowRunTest, LearnsTheDisplayAnewOnAMonitorOfAnotherRate) {
  turn(2);
  const Duration before = run_->path().nominal_period();
  run_->window().set_refresh_hz(144.0);
  for (int i = 0; i < 2000 && run_->path().nominal_period() == before; ++i) turn(1);
  EXPECT_EQ(run_->path().nominal_period(), Duration::period_of_hz(144.0));
}

bool has_note(const SceneState& scene, const std::string& words) {
  return std::any_of(scene.notes.begin(), scene.notes.end(), [&](const std::string& note) {
    return note.find(words) != std::string::npos;
  });
}

TEST_F(WindowRunTest, SaysWhoseAvatarIsMissing) {
  for (const char* name : {"alice", "bob"}) {
    Avatar avatar;
    avatar.name = *GuestId::parse("no-such-avatar");
    source_.board().on_avatar(*GuestId::parse(name), avatar, mono_now());
  }
  turn(2);
  EXPECT_TRUE(has_note(run_->scene(), "alice's avatar no-such-avatar is not among those here"));
  const std::size_t notes = run_->scene().notes.size();
  turn(3);
  EXPECT_EQ(run_->scene().notes.size(), notes) << "told once in each picture";
}

TEST_F(WindowRunTest, EscClosesAPanelBeforeTheWindow) {
  turn(1);
  press(GLFW_KEY_I);
  press(GLFW_KEY_S);
  turn(2);
  press(GLFW_KEY_ESCAPE);
  press(GLFW_KEY_ESCAPE);
  EXPECT_FALSE(run_->is_over());
  press(GLFW_KEY_ESCAPE);
  EXPECT_TRUE(run_->is_over());
}

}  // namespace
}  // namespace dance
