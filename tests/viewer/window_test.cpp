// The window's way to pixels, under a virtual display of its own: what is on the screen is what a
// headless run writes.

#include <gtest/gtest.h>
#include <poll.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstdlib>
#include <string>

#include "tests/viewer/driver_memory.h"
#include "tests/viewer/test_scene.h"
#include "viewer/offscreen.h"
#include "viewer/stage_painter.h"
#include "viewer/view_window.h"

namespace dance {
namespace {

constexpr int kWidth_px = 480;
constexpr int kHeight_px = 300;

// An X server that ends with the test; display() is empty where there is none.
class VirtualDisplay {
 public:
  VirtualDisplay() {
    std::array<int, 2> ends{};
    if (pipe(ends.data()) != 0) return;
    pid_ = fork();
    if (pid_ == 0) {
      close(ends[0]);
      const std::string fd = std::to_string(ends[1]);
      execlp("Xvfb", "Xvfb", "-displayfd", fd.c_str(), "-screen", "0", "800x600x24", "-nolisten",
             "tcp", "+extension", "GLX", "-noreset", nullptr);
      _exit(127);
    }
    close(ends[1]);
    // The number and its end of line come in two writes.
    std::string number;
    pollfd readable{ends[0], POLLIN, 0};
    for (char c = 0; c != '\n' && poll(&readable, 1, 20'000) == 1;) {
      if (read(ends[0], &c, 1) != 1) break;
      if (c == '\n')
        display_ = ":" + number;
      else
        number += c;
    }
    close(ends[0]);
  }
  ~VirtualDisplay() {
    if (pid_ <= 0) return;
    kill(pid_, SIGTERM);
    waitpid(pid_, nullptr, 0);
  }
  const std::string& display() const { return display_; }

 private:
  pid_t pid_ = -1;
  std::string display_;
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
  CameraRig rig(CameraPreset::kAuto);
  const auto window = ViewWindow::create({kWidth_px, kHeight_px}, rig);
  ASSERT_FALSE(window);
  EXPECT_NE(window.error().what.find("--headless"), std::string::npos);
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
    ASSERT_TRUE((*painter)->draw(scene, camera, kWidth_px, kHeight_px, {}));
    headless = (*painter)->read();
  }
  const VirtualDisplay display;
  if (display.display().empty()) GTEST_SKIP() << "no Xvfb here; apt-get install xvfb";
  setenv("DISPLAY", display.display().c_str(), 1);
  CameraRig rig(CameraPreset::kAuto);
  auto window = ViewWindow::create({kWidth_px, kHeight_px}, rig);
  if (!window) GTEST_SKIP() << window.error().what;
  keep_drivers_loaded();
  ASSERT_EQ((*window)->framebuffer_size().width_px, kWidth_px);
  auto painter = StagePainter::create(Quality::kHigh, 1.0f);
  ASSERT_TRUE(painter) << painter.error().what;
  ASSERT_TRUE((*painter)->draw(scene, camera, kWidth_px, kHeight_px, {}));
  (*painter)->present();
  glBindFramebuffer(GL_READ_FRAMEBUFFER, 0);
  const Picture shown = read_bound_framebuffer(kWidth_px, kHeight_px);
  (*window)->swap();
  EXPECT_EQ(glGetError(), static_cast<GLenum>(GL_NO_ERROR));
  ASSERT_EQ(shown.rgb.size(), headless.rgb.size());
  EXPECT_LT(mean_difference(shown, headless), 0.5);
  EXPECT_FALSE((*window)->is_over());
}

}  // namespace
}  // namespace dance
