#include "producers/camera/v4l2/video_mode.h"

#include <gtest/gtest.h>
#include <linux/videodev2.h>

#include <vector>

namespace dance {
namespace {

constexpr std::uint32_t kYuyv = V4L2_PIX_FMT_YUYV;
constexpr std::uint32_t kMjpg = V4L2_PIX_FMT_MJPEG;
constexpr std::uint32_t kNv12 = V4L2_PIX_FMT_NV12;
constexpr std::uint32_t kGrey = V4L2_PIX_FMT_GREY;

std::string chosen(const std::vector<VideoMode>& modes, const CameraWish& wish = {}) {
  const auto mode = choose_mode(modes, wish);
  return mode ? text_of(*mode) : mode.error().what;
}

// What a usual webcam on USB 2 offers.
std::vector<VideoMode> webcam() {
  return {{kYuyv, 640, 480, 1, 30},   {kYuyv, 1280, 720, 1, 10}, {kYuyv, 1920, 1080, 1, 5},
          {kMjpg, 640, 480, 1, 30},   {kMjpg, 1280, 720, 1, 30}, {kMjpg, 1280, 720, 1, 60},
          {kMjpg, 1280, 720, 1, 120}, {kMjpg, 1920, 1080, 1, 30}};
}

CameraWish wish_of(std::optional<int> width_px, std::optional<int> height_px,
                   std::optional<double> hz = {}, const std::string& encoding = "") {
  return {width_px, height_px, hz, encoding, 0};
}

TEST(VideoMode, TheUsualWishIsTheFastestUpToSixtyHertz) {
  EXPECT_EQ(chosen(webcam()), "1280x720 MJPG at 60 Hz");
}

TEST(VideoMode, WithoutLossIsBetterAtTheSameRate) {
  EXPECT_EQ(chosen({{kMjpg, 1280, 720, 1, 30}, {kYuyv, 1280, 720, 1, 30}}),
            "1280x720 YUYV at 30 Hz");
  EXPECT_EQ(chosen({{kMjpg, 1280, 720, 1, 30}, {kNv12, 1280, 720, 1, 30}}),
            "1280x720 NV12 at 30 Hz");
  EXPECT_EQ(chosen({{kGrey, 1280, 720, 1, 30}, {kMjpg, 1280, 720, 1, 30}}),
            "1280x720 MJPG at 30 Hz");
  EXPECT_EQ(chosen(webcam(), wish_of(640, 480)), "640x480 YUYV at 30 Hz");
}

TEST(VideoMode, AWishIsMetAsFarAsItGoes) {
  EXPECT_EQ(chosen(webcam(), wish_of(1920, 1080)), "1920x1080 MJPG at 30 Hz");
  EXPECT_EQ(chosen(webcam(), wish_of({}, 1080)), "1920x1080 MJPG at 30 Hz");
  EXPECT_EQ(chosen(webcam(), wish_of(640, {})), "640x480 YUYV at 30 Hz");
  EXPECT_EQ(chosen(webcam(), wish_of({}, {}, 120.0)), "1280x720 MJPG at 120 Hz");
  EXPECT_EQ(chosen(webcam(), wish_of({}, {}, 25.0)), "1280x720 MJPG at 30 Hz");
  EXPECT_EQ(chosen(webcam(), wish_of({}, {}, {}, "YUYV")), "640x480 YUYV at 30 Hz");
  EXPECT_EQ(chosen(webcam(), wish_of(1280, 720, {}, "yuy2")), "1280x720 YUYV at 10 Hz");
  EXPECT_EQ(chosen(webcam(), wish_of(1300, 700, {}, "mjpeg")), "1280x720 MJPG at 60 Hz");
}

TEST(VideoMode, ASlowSizeLosesWhereNobodyAskedForIt) {
  const std::vector<VideoMode> slow{
      {kYuyv, 1280, 720, 1, 10}, {kYuyv, 800, 600, 1, 20}, {kYuyv, 640, 480, 1, 30}};
  EXPECT_EQ(chosen(slow), "640x480 YUYV at 30 Hz");
  EXPECT_EQ(chosen(slow, wish_of(1280, 720)), "1280x720 YUYV at 10 Hz");
  EXPECT_EQ(chosen({{kYuyv, 1280, 720, 1, 10}, {kYuyv, 640, 480, 1, 15}}),
            "1280x720 YUYV at 10 Hz");
  EXPECT_EQ(chosen({{kYuyv, 1280, 720, 1001, 24000}, {kYuyv, 640, 480, 1, 30}}),
            "1280x720 YUYV at 23.98 Hz");
}

TEST(VideoMode, FasterThanSixtyOnlyWhereThereIsNothingElse) {
  EXPECT_EQ(chosen({{kYuyv, 1280, 720, 1, 90}, {kYuyv, 1280, 720, 1, 240}}),
            "1280x720 YUYV at 90 Hz");
  // 60000/1001 and 60 are sixty.
  EXPECT_EQ(chosen({{kYuyv, 1280, 720, 1001, 60000}, {kYuyv, 1280, 720, 1, 30}}),
            "1280x720 YUYV at 59.94 Hz");
}

TEST(VideoMode, ARateThatIsNotSaidIsTheLast) {
  EXPECT_EQ(chosen({{kYuyv, 1280, 720, 0, 0}}), "1280x720 YUYV at a rate it does not say");
  EXPECT_EQ(chosen({{kYuyv, 1280, 720, 0, 0}, {kMjpg, 1280, 720, 1, 30}}),
            "1280x720 MJPG at 30 Hz");
}

TEST(VideoMode, OfTwoEyesSideBySideTheWidthAsks) {
  const std::vector<VideoMode> two_eyes{{kYuyv, 4416, 1242, 1, 15},
                                        {kYuyv, 3840, 1080, 1, 30},
                                        {kYuyv, 2560, 720, 1, 60},
                                        {kYuyv, 1344, 376, 1, 100}};
  EXPECT_EQ(chosen(two_eyes, wish_of(2560, 720)), "2560x720 YUYV at 60 Hz");
  EXPECT_EQ(chosen(two_eyes, wish_of({}, 1080)), "3840x1080 YUYV at 30 Hz");
}

TEST(VideoMode, WhatCannotBeReadIsNotChosen) {
  const auto h264 = v4l2_fourcc('H', '2', '6', '4');
  EXPECT_EQ(chosen({{h264, 1280, 720, 1, 60}, {kYuyv, 320, 240, 1, 15}}), "320x240 YUYV at 15 Hz");
  EXPECT_EQ(chosen({{kYuyv, 641, 480, 1, 30}, {kNv12, 640, 481, 1, 30}, {kYuyv, 320, 240, 1, 30}}),
            "320x240 YUYV at 30 Hz");
  EXPECT_EQ(chosen({{h264, 1280, 720, 1, 60}}),
            "no format that can be read; it offers H264, and YUYV, NV12, MJPG, JPEG and GREY can "
            "be read");
  EXPECT_EQ(chosen({}),
            "no format that can be read; it offers none, and YUYV, NV12, MJPG, JPEG and GREY can "
            "be read");
  EXPECT_EQ(chosen(webcam(), wish_of({}, {}, {}, "NV12")),
            "no pictures in NV12; it offers YUYV, MJPG, of which YUYV, NV12, MJPG, JPEG and GREY "
            "can be read");
}

TEST(VideoMode, TheOrderOfTheListDoesNotMatter) {
  std::vector<VideoMode> modes = webcam();
  for (std::size_t i = 0; i < modes.size(); ++i) {
    std::rotate(modes.begin(), modes.begin() + 1, modes.end());
    EXPECT_EQ(chosen(modes), "1280x720 MJPG at 60 Hz");
  }
}

TEST(VideoMode, SaysWhatWasAskedFor) {
  EXPECT_EQ(text_of(CameraWish{}), "1280x720 at up to 60 Hz");
  EXPECT_EQ(text_of(wish_of({}, 480, 50.0, "nv12")), "height 480 NV12 at 50 Hz");
}

}  // namespace
}  // namespace dance
