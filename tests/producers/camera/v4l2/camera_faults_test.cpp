// What goes wrong with cameras, as dance_video_shim plays it.
#include <gtest/gtest.h>

#include "producers/camera/v4l2/camera_list.h"
#include "producers/camera/v4l2/v4l2_camera.h"
#include "tests/producers/camera/v4l2/shim_fixture.h"

namespace dance {
namespace {

using CameraFaults = CameraTest;

bool says(const std::string& line, const std::string& part) {
  return line.find(part) != std::string::npos && line.find('\n') == std::string::npos;
}

TEST_F(CameraFaults, GapsAreCounted) {
  shim_->set_up("modes=YUYV:64x48@30 gap=1,2,4");
  add_numbered(64, 48);
  const auto camera = opened();
  ASSERT_NE(camera, nullptr);
  Frame frame;
  for (const int number : {0, 3, 5}) {
    while (camera->next(Duration(), frame) != FrameState::kFrame) shim_->tick(1);
    EXPECT_EQ(number_of(frame), number);
  }
  EXPECT_EQ(frame.sequence, 6u);
  EXPECT_EQ(camera->counters().lost, 3u);
  EXPECT_EQ(camera->counters().outrun, 0u);
}

TEST_F(CameraFaults, DamagedPicturesAreLeftOut) {
  shim_->set_up("modes=YUYV:64x48@30 error=1,3 truncate=5");
  add_numbered(64, 48);
  const auto camera = opened();
  ASSERT_NE(camera, nullptr);
  Frame frame;
  for (int i = 0; i < 8; ++i) {
    shim_->tick(1);
    const FrameState state = camera->next(Duration(), frame);
    if (i == 1 || i == 3 || i == 5) {
      EXPECT_EQ(state, FrameState::kNone) << i;
    } else {
      ASSERT_EQ(state, FrameState::kFrame) << i;
      EXPECT_EQ(number_of(frame), i);
    }
  }
  EXPECT_EQ(camera->counters().damaged, 3u);
  EXPECT_EQ(camera->counters().taken, 5u);
  EXPECT_EQ(camera->counters().lost, 0u);
  EXPECT_EQ(shim_->free_buffers(), 4);
}

TEST_F(CameraFaults, ADamagedNewestLeavesTheOneBeforeIt) {
  shim_->set_up("modes=YUYV:64x48@30 error=2");
  add_numbered(64, 48);
  const auto camera = opened();
  ASSERT_NE(camera, nullptr);
  Frame frame;
  shim_->tick(3);
  ASSERT_EQ(camera->next(kFrameTimeout, frame), FrameState::kFrame);
  EXPECT_EQ(number_of(frame), 1);
  EXPECT_EQ(camera->counters().damaged, 1u);
  EXPECT_EQ(camera->counters().outrun, 1u);
}

TEST_F(CameraFaults, ACutJpegIsDamagedAndTheNextIsNot) {
  shim_->set_up("modes=MJPG:96x64@30 truncate=1");
  add(jpeg_of(drawn_colours(96, 64)));
  const auto camera = opened();
  ASSERT_NE(camera, nullptr);
  Frame frame;
  for (const bool is_whole : {true, false, true}) {
    shim_->tick(1);
    EXPECT_EQ(camera->next(Duration(), frame), is_whole ? FrameState::kFrame : FrameState::kNone);
  }
  EXPECT_EQ(camera->counters().damaged, 1u);
}

TEST_F(CameraFaults, WaitsForACameraThatIsSlowToStart) {
  shim_->set_up("modes=YUYV:64x48@30");
  add_numbered(64, 48);
  const auto camera = opened();
  ASSERT_NE(camera, nullptr);
  Frame frame;
  for (int i = 0; i < 5; ++i) EXPECT_EQ(camera->next(Duration::ms(1), frame), FrameState::kNone);
  shim_->tick(1);
  EXPECT_EQ(camera->next(kFrameTimeout, frame), FrameState::kFrame);
}

// Asks until something else comes than `is_over`.
FrameState after(FrameState is_over, V4l2Camera& camera, Frame& frame) {
  FrameState state = is_over;
  for (int i = 0; i < 100'000 && state == is_over; ++i) state = camera.next(Duration::ms(1), frame);
  return state;
}

TEST_F(CameraFaults, AnUnpluggedCameraComesBackUnderAnotherNumber) {
  shim_->set_up("modes=YUYV:64x48@30");
  add_numbered(64, 48);
  const auto camera = opened();
  ASSERT_NE(camera, nullptr);
  Frame frame;
  shim_->tick(2);
  ASSERT_EQ(camera->next(kFrameTimeout, frame), FrameState::kFrame);
  const std::uint64_t before = frame.sequence;
  shim_->tick(1);  // what still waits goes with the cable
  shim_->unplug();
  EXPECT_EQ(camera->next(kFrameTimeout, frame), FrameState::kGone);
  for (int i = 0; i < 5; ++i) EXPECT_EQ(camera->next(Duration::ms(2), frame), FrameState::kGone);
  EXPECT_EQ(camera->negotiated(), "Shim Camera (/dev/video42): unplugged");

  shim_->change("device=47 bus=usb-shim-3");
  shim_->plug();
  ASSERT_EQ(after(FrameState::kGone, *camera, frame), FrameState::kBack);
  EXPECT_EQ(camera->name(), "Shim Camera (/dev/video47)");
  shim_->tick(1);
  ASSERT_EQ(camera->next(kFrameTimeout, frame), FrameState::kFrame);
  EXPECT_EQ(number_of(frame), 0);
  EXPECT_GT(frame.sequence, before);
  EXPECT_EQ(camera->counters().unplugged, 1u);
  EXPECT_EQ(camera->counters().lost, 0u);
}

TEST_F(CameraFaults, ACameraThatHangsIsOpenedAnew) {
  shim_->set_up("modes=YUYV:64x48@1000");
  add_numbered(64, 48);
  stalled_after_ = Duration::ms(20);
  const auto camera = opened();
  ASSERT_NE(camera, nullptr);
  Frame frame;
  ASSERT_EQ(after(FrameState::kNone, *camera, frame), FrameState::kGone);
  ASSERT_EQ(after(FrameState::kGone, *camera, frame), FrameState::kBack);
  shim_->tick(1);
  EXPECT_EQ(camera->next(kFrameTimeout, frame), FrameState::kFrame);
  EXPECT_EQ(camera->counters().unplugged, 1u);
}

TEST_F(CameraFaults, AnotherCameraIsNotTakenForTheLostOne) {
  shim_->set_up("modes=YUYV:64x48@30");
  const auto camera = opened();
  ASSERT_NE(camera, nullptr);
  Frame frame;
  shim_->unplug();
  EXPECT_EQ(camera->next(kFrameTimeout, frame), FrameState::kGone);
  shim_->change("card=Another_Camera");
  shim_->plug();
  for (int i = 0; i < 20; ++i) EXPECT_EQ(camera->next(Duration::ms(2), frame), FrameState::kGone);
  // Nor while another program has it.
  shim_->change("card=Shim_Camera busy=1");
  for (int i = 0; i < 20; ++i) EXPECT_EQ(camera->next(Duration::ms(2), frame), FrameState::kGone);
  shim_->change("busy=0");
  EXPECT_EQ(after(FrameState::kGone, *camera, frame), FrameState::kBack);
}

TEST_F(CameraFaults, ErrorsNameTheDeviceTheReasonAndTheCure) {
  shim_->set_up("modes=YUYV:64x48@30 busy=1");
  EXPECT_TRUE(says(why_not(kPath),
                   "Shim Camera (/dev/video42): in use by another program; close it (fuser -v"));
  shim_->set_up("modes=YUYV:64x48@30 denied=1");
  EXPECT_TRUE(
      says(why_not(kPath), "/dev/video42: no permission; be in the group video (sudo usermod"));
  EXPECT_TRUE(says(why_not(""), "no permission"));
  shim_->set_up("modes=YUYV:64x48@30");
  const std::string missing = why_not("/dev/video63");
  EXPECT_TRUE(says(missing, "/dev/video63: there is no such camera; these are there:")) << missing;
  EXPECT_TRUE(says(missing, "/dev/video42 (Shim Camera)")) << missing;
  EXPECT_TRUE(says(why_not("63"), "/dev/video63: there is no such camera"));
  EXPECT_TRUE(says(why_not("elgato"), "no camera is called 'elgato'; these are there:"));
  EXPECT_TRUE(
      says(why_not("/dev/null"), "/dev/null: is no video device; cameras are called /dev/video0"));
  EXPECT_TRUE(says(why_not("/dev"), "/dev: cannot be opened: Is a directory"));
  shim_->set_up("modes=YUYV:64x48@30 metadata=1");
  EXPECT_TRUE(
      says(why_not("/dev/video43"), "gives no pictures; a camera often has a second device"));
  shim_->set_up("modes=H264:1280x720@30,RGB3:640x480@30");
  EXPECT_TRUE(says(why_not(kPath), "no format that can be read; it offers H264, RGB3, and YUYV"));
  shim_->set_up("modes=YUYV:64x48@30");
  CameraWish wish;
  wish.encoding = "nv12";
  EXPECT_TRUE(says(why_not(kPath, wish), "no pictures in NV12; it offers YUYV"));
  shim_->set_up("modes=YUYV:64x48@30 makes=H264:64x48@30");
  EXPECT_TRUE(says(why_not(kPath), "Shim Camera (/dev/video42): pictures in H264 cannot be read"));
}

TEST_F(CameraFaults, TheListLeavesOutWhatGivesNoPictures) {
  shim_->set_up("modes=YUYV:64x48@30,MJPG:64x48@60 metadata=1");
  const auto is_there = [](const std::string& path) {
    for (const CameraEntry& camera : list_cameras()) {
      if (camera.path == path) return true;
    }
    return false;
  };
  EXPECT_TRUE(is_there("/dev/video42"));
  EXPECT_FALSE(is_there("/dev/video43"));
  shim_->unplug();
  EXPECT_FALSE(is_there("/dev/video42"));
}

TEST_F(CameraFaults, ACameraIsFoundByAPartOfItsName) {
  shim_->set_up("modes=YUYV:64x48@30 card=Dance_Floor_HD_Pro");
  auto camera = V4l2Camera::open("floor hd");
  ASSERT_TRUE(camera.has_value()) << camera.error().what;
  EXPECT_EQ((*camera)->name(), "Dance Floor HD Pro (/dev/video42)");
}

}  // namespace
}  // namespace dance
