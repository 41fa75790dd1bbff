#include "producers/camera/v4l2/camera_list.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <linux/videodev2.h>
#include <unistd.h>

#include <array>
#include <filesystem>
#include <fstream>

#include "core/program/child_process.h"
#include "producers/camera/v4l2/v4l2_device.h"

namespace dance {
namespace {

constexpr std::uint32_t kListedYuyv = V4L2_PIX_FMT_YUYV;

std::vector<CameraEntry> two_of_a_kind() {
  return {{"/dev/video0", "HD Webcam", "usb-1", {{kListedYuyv, 640, 480, 1, 30}}, ""},
          {"/dev/video2", "HD Webcam", "usb-2", {{kListedYuyv, 640, 480, 1, 30}}, ""},
          {"/dev/video4", "HD Webcam Pro", "usb-3", {{kListedYuyv, 640, 480, 1, 30}}, ""}};
}

TEST(CameraList, TheTableSaysWhatACameraOffersAndWhatIsTaken) {
  const std::vector<CameraEntry> cameras{
      {"/dev/video0",
       "HD Webcam",
       "usb-0000:00:14.0-1",
       {{kListedYuyv, 640, 480, 1, 30},
        {kListedYuyv, 640, 480, 1, 15},
        {V4L2_PIX_FMT_MJPEG, 1280, 720, 1001, 30000},
        {v4l2_fourcc('H', '2', '6', '4'), 1920, 1080, 1, 30},
        {v4l2_fourcc('H', '2', '6', '4'), 1280, 720, 1, 30},
        {V4L2_PIX_FMT_Y16_BE, 1280, 720, 1, 30},
        {V4L2_PIX_FMT_NV12, 640, 480, 0, 0}},
       ""},
      {"/dev/video2", "", "", {}, "/dev/video2: no permission; be in the group video"}};
  EXPECT_EQ(camera_table(cameras),
            "/dev/video0  HD Webcam  (usb-0000:00:14.0-1)\n"
            "  YUYV 640x480     15 30 Hz\n"
            "  MJPG 1280x720    29.97 Hz\n"
            "  NV12 640x480     ? Hz\n"
            "  not read: H264 Y16-BE\n"
            "  taken unless asked otherwise: 1280x720 MJPG at 29.97 Hz\n"
            "/dev/video2: no permission; be in the group video\n");
}

TEST(CameraList, NamesOfDriversMoveNoCursorAndChangeNoDirectionOfText) {
  const std::vector<CameraEntry> cameras{{"/dev/video0", "HD\x1b[2J\u202eCam", "usb\n1", {}, ""}};
  EXPECT_TRUE(camera_table(cameras).starts_with("/dev/video0  HD?[2J?Cam  (usb?1)\n"))
      << camera_table(cameras);
  EXPECT_NE(camera_json(cameras).find("HD?[2J?Cam"), std::string::npos) << camera_json(cameras);
}

TEST(CameraList, WithoutACameraItSaysWhatToDo) {
  EXPECT_NE(camera_table({}).find("no camera is there: plug one in"), std::string::npos);
  EXPECT_EQ(camera_table({}).find('\n'), camera_table({}).size() - 1);
  const auto path = camera_path("", {});
  ASSERT_FALSE(path.has_value());
  EXPECT_NE(path.error().what.find("no camera is there"), std::string::npos);
}

TEST(CameraList, ACameraIsCalledByPathNumberOrName) {
  const std::vector<CameraEntry> cameras = two_of_a_kind();
  EXPECT_EQ(camera_path("/dev/video7", cameras).value(), "/dev/video7");
  EXPECT_EQ(camera_path("2", cameras).value(), "/dev/video2");
  EXPECT_EQ(camera_path("", cameras).value(), "/dev/video0");
  EXPECT_EQ(camera_path("auto", cameras).value(), "/dev/video0");
  EXPECT_EQ(camera_path("hd webcam", cameras).value(), "/dev/video0");
  EXPECT_EQ(camera_path("PRO", cameras).value(), "/dev/video4");
  EXPECT_FALSE(camera_path("elgato", cameras).has_value());
}

TEST(CameraList, TheFirstThatSeesColoursIsTaken) {
  std::vector<CameraEntry> cameras{
      {"/dev/video0", "Loopback", "virtual-1", {}, ""},
      {"/dev/video1", "Notebook: I", "usb-1", {{V4L2_PIX_FMT_GREY, 640, 360, 1, 30}}, ""},
      {"/dev/video2", "Notebook: C", "usb-1", {{kListedYuyv, 640, 480, 1, 30}}, ""},
      {"/dev/video3", "Another", "usb-2", {{kListedYuyv, 1280, 720, 1, 30}}, ""}};
  EXPECT_EQ(camera_path("", cameras).value(), "/dev/video2");
  EXPECT_EQ(camera_path("notebook", cameras).value(), "/dev/video2");
  EXPECT_EQ(camera_path("Notebook: I", cameras).value(), "/dev/video1");
  cameras.resize(2);
  EXPECT_EQ(camera_path("auto", cameras).value(), "/dev/video1");
  cameras.resize(1);
  EXPECT_EQ(camera_path("auto", cameras).value(), "/dev/video0");
  cameras[0].trouble = "/dev/video0: no permission";
  EXPECT_EQ(camera_path("auto", cameras).error().what, "/dev/video0: no permission");
}

TEST(CameraList, OneIsFoundAgainInItsSocketOrInAFreeOne) {
  const std::vector<CameraEntry> cameras = two_of_a_kind();
  const std::vector<std::string> others{"usb-2"};
  CameraEntry lost = cameras[0];
  EXPECT_EQ(found_again(lost, others, cameras), &cameras[0]);
  // Its sister was there before: that is not it.
  const std::span<const CameraEntry> sisters = std::span(cameras).subspan(1);
  EXPECT_EQ(found_again(lost, others, sisters), nullptr);
  // Where it was alone of its name, any socket will do.
  EXPECT_EQ(found_again(lost, {}, sisters), &cameras[1]);
  lost.name = "Another";
  EXPECT_EQ(found_again(lost, {}, cameras), nullptr);
}

TEST(CameraList, SaysWhichProgramHasAFileOpen) {
  const std::string path = testing::TempDir() + "dance_held_" + std::to_string(::getpid());
  std::ofstream(path) << "x";
  EXPECT_EQ(holders_of(path), "");
  EXPECT_EQ(holders_of(path + "_missing"), "");
  const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  ASSERT_GE(file, 0);
  auto child = ChildProcess::start({.program = "sleep", .arguments = {"1000"}, .input_fd = file});
  ::close(file);
  ASSERT_TRUE(child) << child.error().what;
  // The child has its name only after exec.
  const std::string expected = "sleep (" + std::to_string(child->pid()) + ")";
  std::string found;
  for (int i = 0; i < 10'000 && found != expected; ++i) {
    found = holders_of(path);
    ::usleep(1'000);
  }
  EXPECT_EQ(found, expected);
  child->kill_now();
  std::filesystem::remove(path);
}

}  // namespace
}  // namespace dance
