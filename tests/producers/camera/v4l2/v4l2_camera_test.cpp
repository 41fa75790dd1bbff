// A camera as dance_video_shim plays it: what comes, in which colours, when, and what a slow reader
// gets.
#include "producers/camera/v4l2/v4l2_camera.h"

#include <gtest/gtest.h>

#include <opencv2/core.hpp>

#include "core/net/mono_clock.h"
#include "tests/allocation_guard.h"
#include "tests/producers/camera/v4l2/shim_fixture.h"

namespace dance {
namespace {

class Colours : public CameraTest, public testing::WithParamInterface<const char*> {};

TEST_P(Colours, AreThoseThatTheCameraSaw) {
  const std::string encoding = GetParam();
  const cv::Mat seen = drawn_colours(96, 64);
  for (const int pad_bytes : {0, 64}) {
    if (encoding == "MJPG" && pad_bytes != 0) continue;
    shim_->set_up(("modes=" + encoding + ":96x64@30 pad=" + std::to_string(pad_bytes)).c_str());
    add(encoding == "YUYV" ? yuyv_of(seen) : encoding == "NV12" ? nv12_of(seen) : jpeg_of(seen));
    const auto camera = opened();
    ASSERT_NE(camera, nullptr);
    shim_->tick(1);
    Frame frame;
    ASSERT_EQ(camera->next(kFrameTimeout, frame), FrameState::kFrame);
    EXPECT_LT(mean_difference(frame.image, seen), 2.5) << encoding << " padded by " << pad_bytes;
    EXPECT_EQ(camera->format().encoding, encoding);
    EXPECT_EQ(camera->format().width_px, 96);
    EXPECT_EQ(camera->format().height_px, 64);
    EXPECT_EQ(camera->format().hz, 30.0);
  }
}
INSTANTIATE_TEST_SUITE_P(Camera, Colours, testing::Values("YUYV", "NV12", "MJPG"),
                         [](const auto& test) { return std::string(test.param); });

TEST_F(CameraTest, StampsAreTheDrivers) {
  shim_->set_up("modes=YUYV:64x48@30 age_ms=200");
  add_numbered(64, 48);
  const auto camera = opened();
  ASSERT_NE(camera, nullptr);
  shim_->tick(1);
  Frame frame;
  ASSERT_EQ(camera->next(kFrameTimeout, frame), FrameState::kFrame);
  EXPECT_EQ(frame.capture_time.since_zero_us(), shim_->newest_stamp_us());
  EXPECT_GE(frame.fetched, frame.capture_time);
  EXPECT_LE(frame.fetched, mono_now());
  EXPECT_TRUE(camera->has_driver_stamps());
  EXPECT_EQ(camera->name(), "Shim Camera (/dev/video42)");
}

TEST_F(CameraTest, SaysWhereTheDriverHasAnotherClock) {
  for (const char* stamp : {"realtime", "zero"}) {
    shim_->set_up((std::string("modes=YUYV:64x48@30 stamp=") + stamp).c_str());
    add_numbered(64, 48);
    const auto camera = opened();
    ASSERT_NE(camera, nullptr);
    const MonoTime before = mono_now();
    shim_->tick(1);
    Frame frame;
    ASSERT_EQ(camera->next(kFrameTimeout, frame), FrameState::kFrame);
    EXPECT_GE(frame.capture_time, before);
    EXPECT_LE(frame.capture_time, mono_now());
    EXPECT_EQ(frame.fetched, frame.capture_time);
    EXPECT_FALSE(camera->has_driver_stamps());
    EXPECT_NE(camera->negotiated().find("stamped when fetched"), std::string::npos);
  }
}

TEST_F(CameraTest, AStampThatCannotBeIsTheLastThatIsBelieved) {
  // Of the future; older than the one before; older than anything that waits.
  for (const char* odd : {"age_ms=-60000", "age_ms=8000", "age_ms=20000"}) {
    shim_->set_up("modes=YUYV:64x48@30");
    add_numbered(64, 48);
    const auto camera = opened();
    ASSERT_NE(camera, nullptr);
    Frame frame;
    MonoTime last;
    for (const char* words : {"age_ms=0", odd, "age_ms=100", "age_ms=0"}) {
      shim_->change(words);
      const MonoTime before = mono_now();
      shim_->tick(1);
      ASSERT_EQ(camera->next(kFrameTimeout, frame), FrameState::kFrame);
      EXPECT_GE(frame.capture_time, last) << odd << ", then " << words;
      last = frame.capture_time;
      EXPECT_LE(last, mono_now());
      if (!camera->has_driver_stamps()) {
        EXPECT_GE(last, before) << odd << ", then " << words;
      }
    }
    EXPECT_FALSE(camera->has_driver_stamps()) << odd;
  }
}

TEST_F(CameraTest, GivesASlowReaderTheNewestAndCountsTheRest) {
  shim_->set_up("modes=YUYV:64x48@30");
  add_numbered(64, 48);
  const auto camera = opened();
  ASSERT_NE(camera, nullptr);
  Frame frame;
  shim_->tick(1);
  ASSERT_EQ(camera->next(kFrameTimeout, frame), FrameState::kFrame);
  EXPECT_EQ(number_of(frame), 0);
  const std::uint64_t first = frame.sequence;
  shim_->tick(3);
  ASSERT_EQ(camera->next(kFrameTimeout, frame), FrameState::kFrame);
  EXPECT_EQ(number_of(frame), 3);
  EXPECT_EQ(frame.sequence, first + 3);
  EXPECT_EQ(camera->counters().taken, 2u);
  EXPECT_EQ(camera->counters().outrun, 2u);
  EXPECT_EQ(camera->counters().lost, 0u);
  EXPECT_EQ(shim_->free_buffers(), 4) << "buffers that were not given back";
  EXPECT_EQ(camera->next(Duration(), frame), FrameState::kNone);
}

TEST_F(CameraTest, DoesNotShowWhatWaitedWhileTheDriverHadNoRoomForTheNew) {
  // Four buffers fill, the next five pictures find no room: what waits is old, and what comes next
  // is shown instead.
  shim_->set_up("modes=YUYV:64x48@30 age_ms=300");
  add_numbered(64, 48);
  const auto camera = opened();
  ASSERT_NE(camera, nullptr);
  shim_->tick(9);
  Frame frame;
  EXPECT_EQ(camera->next(Duration(), frame), FrameState::kNone);
  EXPECT_EQ(camera->counters().outrun, 4u);
  EXPECT_EQ(shim_->free_buffers(), 4);
  shim_->tick(1);
  ASSERT_EQ(camera->next(kFrameTimeout, frame), FrameState::kFrame);
  EXPECT_EQ(number_of(frame), 9);
  EXPECT_EQ(camera->counters().lost, 5u);
  // Somebody who is always so slow still gets pictures: every second time.
  shim_->tick(9);
  EXPECT_EQ(camera->next(Duration(), frame), FrameState::kNone);
  shim_->tick(9);
  EXPECT_EQ(camera->next(Duration(), frame), FrameState::kFrame);
}

TEST_F(CameraTest, AFrameThatIsStillHeldIsNotPaintedOver) {
  shim_->set_up("modes=YUYV:64x48@30");
  add_numbered(64, 48);
  const auto camera = opened();
  ASSERT_NE(camera, nullptr);
  Frame first, second;
  shim_->tick(1);
  ASSERT_EQ(camera->next(kFrameTimeout, first), FrameState::kFrame);
  shim_->tick(1);
  ASSERT_EQ(camera->next(kFrameTimeout, second), FrameState::kFrame);
  EXPECT_EQ(number_of(first), 0);
  EXPECT_EQ(number_of(second), 1);
}

TEST_F(CameraTest, PicturesTakeTurnsInTheSameMemory) {
  shim_->set_up("modes=YUYV:64x48@30");
  add_numbered(64, 48);
  const auto camera = opened();
  ASSERT_NE(camera, nullptr);
  Frame frame;
  const void* memory = nullptr;
  for (int i = 0; i < 5; ++i) {
    shim_->tick(1);
    ASSERT_EQ(camera->next(kFrameTimeout, frame), FrameState::kFrame);
    if (i == 0) memory = frame.image.data;
    EXPECT_EQ(frame.image.data, memory);
  }
}

TEST_F(CameraTest, APictureAllocatesNothing) {
  cv::setNumThreads(1);
  for (const bool is_planar : {false, true}) {
    shim_->set_up(is_planar ? "modes=NV12:64x48@30" : "modes=YUYV:64x48@30 gap=12 error=14");
    const cv::Mat seen = drawn_grey(64, 48, 100);
    add(is_planar ? nv12_of(seen) : yuyv_of(seen));
    const auto camera = opened();
    ASSERT_NE(camera, nullptr);
    Frame frame;
    for (int i = 0; i < 10; ++i) {
      shim_->tick(1);
      ASSERT_EQ(camera->next(kFrameTimeout, frame), FrameState::kFrame);
    }
    const AllocationGuard guard;
    for (int i = 0; i < 50; ++i) {
      shim_->tick(1 + i % 5);
      camera->next(Duration(), frame);
    }
    EXPECT_EQ(guard.allocations(), 0u) << (is_planar ? "NV12" : "YUYV");
  }
}

TEST_F(CameraTest, TakesWhatTheDriverMadeOfTheWish) {
  shim_->set_up("modes=YUYV:1280x720@30 makes=YUYV:32x24@10");
  add(yuyv_of(drawn_colours(32, 24)));
  const auto camera = opened();
  ASSERT_NE(camera, nullptr);
  shim_->tick(1);
  Frame frame;
  ASSERT_EQ(camera->next(kFrameTimeout, frame), FrameState::kFrame);
  EXPECT_LT(mean_difference(frame.image, drawn_colours(32, 24)), 3.5);
  EXPECT_EQ(camera->format().hz, 10.0);
  EXPECT_EQ(camera->negotiated(),
            "Shim Camera (/dev/video42): 32x24 YUYV at 10 Hz, asked for 1280x720 at up to 60 Hz");
}

TEST_F(CameraTest, FindsASizeThatIsNotListed) {
  shim_->set_up("free=YUYV:16x16-1920x1080/8@60");
  add(yuyv_of(drawn_colours(320, 200)));
  CameraWish wish;
  wish.width_px = 320;
  wish.height_px = 200;
  wish.hz = 25.0;
  const auto camera = opened(wish);
  ASSERT_NE(camera, nullptr);
  EXPECT_EQ(camera->format().width_px, 320);
  EXPECT_EQ(camera->format().height_px, 200);
  EXPECT_EQ(camera->format().hz, 25.0);
}

TEST_F(CameraTest, KeepsTheRateInTheDarkAndLeavesTheCameraAsItWas) {
  shim_->set_up("modes=YUYV:64x48@60 priority=1");
  {
    const auto camera = opened();
    ASSERT_NE(camera, nullptr);
    EXPECT_EQ(shim_->priority(), 0);
    EXPECT_NE(camera->negotiated().find("the rate stays in the dark too"), std::string::npos);
  }
  EXPECT_EQ(shim_->priority(), 1);
}

TEST_F(CameraTest, ReadsMotionJpegOfFourThousandPixels) {
  const cv::Mat seen = drawn_colours(3840, 2160);
  shim_->set_up("modes=MJPG:3840x2160@30");
  add(jpeg_of(seen));
  for (const int max_height_px : {0, 1080, 720}) {
    CameraWish wish;
    wish.max_height_px = max_height_px;
    const auto camera = opened(wish);
    ASSERT_NE(camera, nullptr);
    shim_->tick(1);
    Frame frame;
    ASSERT_EQ(camera->next(kFrameTimeout, frame), FrameState::kFrame);
    const int height_px = max_height_px == 0 ? 2160 : max_height_px == 1080 ? 1080 : 540;
    EXPECT_EQ(frame.image.rows, height_px);
    EXPECT_EQ(frame.image.cols, height_px * 16 / 9);
    EXPECT_EQ(camera->format().height_px, height_px);
    EXPECT_LT(mean_difference(frame.image, drawn_colours(height_px * 16 / 9, height_px)), 2.5);
  }
}

}  // namespace
}  // namespace dance
