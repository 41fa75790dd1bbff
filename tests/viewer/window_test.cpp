// The window's way to pixels, under a virtual display of its own: what is on the screen is what a
// headless run writes.

#include <gtest/gtest.h>

#include <cstdlib>
#include <string>

#include "tests/viewer/driver_memory.h"
#include "tests/viewer/test_scene.h"
#include "tests/virtual_display.h"
#include "viewer/gl/offscreen.h"
#include "viewer/stage/stage_painter.h"
#include "viewer/window/view_window.h"

namespace dance {
namespace {

constexpr int kWidth_px = 480;
constexpr int kHeight_px = 300;

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
  const auto window = ViewWindow::create({kWidth_px, kHeight_px}, events);
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
  if (display.display().empty()) GTEST_SKIP() << kNoVirtualDisplay;
  setenv("DISPLAY", display.display().c_str(), 1);
  NoEvents events;
  auto window = ViewWindow::create({kWidth_px, kHeight_px}, events);
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
