// A program of its own with a preloaded camera that runs at its own pace, is unplugged and comes
// back.
#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "tests/producers/camera/v4l2/drawn_pictures.h"

namespace dance {
namespace {

struct Ended {
  int status = -1;
  std::string said;
};

// The shell loads it for the program alone.
Ended run_probe(const std::string& shim_words, const std::string& arguments) {
  const std::string command = "LD_PRELOAD=" DANCE_VIDEO_SHIM_PRELOAD " DANCE_VIDEO_SHIM='" +
                              shim_words + "' " DANCE_BINARY_DIR "/tests/camera_probe " +
                              arguments + " 2>&1";
  std::FILE* pipe = ::popen(command.c_str(), "r");
  Ended ended;
  std::array<char, 4096> part{};
  while (std::fgets(part.data(), part.size(), pipe) != nullptr) ended.said += part.data();
  ended.status = ::pclose(pipe);
  return ended;
}

class CameraProgram : public testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    path_ = std::filesystem::path(testing::TempDir()) /
            ("dance_camera_" + std::string(GetParam()) + "_" + std::to_string(::getpid()));
    std::ofstream file(path_, std::ios::binary);
    for (int i = 0; i < 4; ++i) {
      const cv::Mat picture = drawn_colours(320, 240);
      const std::string encoding = GetParam();
      const auto bytes = encoding == "YUYV"   ? yuyv_of(picture)
                         : encoding == "NV12" ? nv12_of(picture)
                                              : jpeg_of(picture);
      file.write(reinterpret_cast<const char*>(bytes.data()),
                 static_cast<std::streamsize>(bytes.size()));
    }
  }
  void TearDown() override { std::filesystem::remove(path_); }
  std::string words() const {
    return "modes=" + std::string(GetParam()) + ":320x240@200 hz=200 file=" + path_.string();
  }
  std::filesystem::path path_;
};

TEST_P(CameraProgram, TakesWhatComesIsUnpluggedAndGoesOn) {
  const Ended ended = run_probe(words() + " unplug=20 replug_ms=100 again=44", "42 30 60 wait");
  EXPECT_EQ(ended.status, 0) << ended.said;
  const auto at = [&](const std::string& part) { return ended.said.find(part); };
  EXPECT_NE(at("Shim Camera (/dev/video42): 320x240 " + std::string(GetParam()) + " at 200 Hz"),
            std::string::npos)
      << ended.said;
  EXPECT_LT(at("picture 1: 320x240"), at("gone\n")) << ended.said;
  EXPECT_LT(at("gone\n"), at("back\n")) << ended.said;
  EXPECT_LT(at("back\n"), at("picture 30: 320x240")) << ended.said;
  EXPECT_NE(at("taken 30 "), std::string::npos) << ended.said;
  EXPECT_NE(at("unplugged 1\n"), std::string::npos) << ended.said;
}
INSTANTIATE_TEST_SUITE_P(Of, CameraProgram, testing::Values("YUYV", "NV12", "MJPG"),
                         [](const auto& test) { return std::string(test.param); });

TEST(CameraPrograms, ListTheCamera) {
  const Ended ended = run_probe(
      "modes=MJPG:1280x720@60,MJPG:1280x720@30,YUYV:1280x720@10 metadata=1 card=HD_Webcam",
      "--list");
  EXPECT_EQ(ended.status, 0);
  EXPECT_NE(ended.said.find("/dev/video42  HD Webcam  (usb-shim-1)\n"
                            "  MJPG 1280x720    30 60 Hz\n"
                            "  YUYV 1280x720    10 Hz\n"
                            "  taken unless asked otherwise: 1280x720 MJPG at 60 Hz\n"),
            std::string::npos)
      << ended.said;
  EXPECT_EQ(ended.said.find("video43"), std::string::npos) << ended.said;
}

TEST(CameraPrograms, SayWhyTheyDoNotStart) {
  const Ended ended = run_probe("modes=YUYV:64x48@30 busy=1", "42 1 10");
  EXPECT_NE(ended.status, 0);
  EXPECT_NE(ended.said.find("in use by another program"), std::string::npos) << ended.said;
}

}  // namespace
}  // namespace dance
