// For tests of cameras: the shim's wheel, where it was preloaded.
//
// Units/frames: pixels.
// Ownership:    refers to the process's one shim.
// Threads:      as the test.
// Failure:      the test is skipped with a line where the shim was not preloaded.
#pragma once

#include <dlfcn.h>
#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "producers/camera/v4l2/v4l2_camera.h"
#include "tests/producers/camera/v4l2/drawn_pictures.h"
#include "tests/producers/camera/v4l2/video_shim.h"

namespace dance {

class CameraTest : public testing::Test {
 protected:
  static constexpr const char* kPath = "/dev/video42";
  // Long enough for any machine; what it waits for comes before it.
  static constexpr Duration kFrameTimeout = Duration::s(60);

  void SetUp() override {
    using Find = VideoShim*();
    auto* const find = reinterpret_cast<Find*>(::dlsym(RTLD_DEFAULT, "dance_video_shim"));
    if (find == nullptr) {
      GTEST_SKIP() << "no camera to test with: start through ctest, or with "
                      "LD_PRELOAD=<build>/tests/libdance_video_shim.so";
    }
    shim_ = find();
  }
  void TearDown() override {
    if (shim_ == nullptr) return;
    EXPECT_EQ(shim_->open_files(), 0) << "a camera was left open";
  }

  void add(const std::vector<std::uint8_t>& bytes) {
    shim_->add_picture(bytes.data(), bytes.size());
  }
  // Ten pictures, each of its own grey, that tell by themselves which they are.
  void add_numbered(int width_px, int height_px) {
    for (int i = 0; i < 10; ++i) add(yuyv_of(drawn_grey(width_px, height_px, level_of_picture(i))));
  }
  static int number_of(const Frame& frame) {
    for (int i = 0; i < 10; ++i) {
      if (std::abs(mean_level(frame.image) - level_of_picture(i)) < 3.0) return i;
    }
    return -1;
  }
  std::unique_ptr<V4l2Camera> opened(const CameraWish& wish = {}) {
    auto camera = V4l2Camera::open(kPath, wish, {Duration::ms(1), stalled_after_});
    EXPECT_TRUE(camera.has_value()) << (camera ? "" : camera.error().what);
    return camera ? std::move(*camera) : nullptr;
  }
  static std::string why_not(const std::string& called, const CameraWish& wish = {}) {
    auto camera = V4l2Camera::open(called, wish);
    return camera ? "it was opened" : camera.error().what;
  }

  VideoShim* shim_ = nullptr;
  Duration stalled_after_ = Duration::s(3600);  // a machine that sleeps is no camera that hangs
};

}  // namespace dance
