#include "producers/camera/view/preview.h"

#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <thread>

#include "producers/camera/files/bgr_picture.h"
#include "tests/producers/camera/view/standing_body.h"

namespace dance {
namespace {

std::string file_for(const std::string& name) {
  const std::string folder = std::string(DANCE_BINARY_DIR) + "/preview-test";
  std::filesystem::create_directories(folder);
  const std::string file = folder + "/" + name;
  std::filesystem::remove(file);
  return file;
}

PreviewOptions to_file(const std::string& file, bool is_mirrored = false) {
  PreviewOptions options;
  options.file = file;
  options.is_mirrored = is_mirrored;
  return options;
}

// Shows the same until the file is what `is_so` waits for.
template <class IsSo>
cv::Mat shown(Preview& preview, const std::string& file, const Frame& frame, const IsSo& is_so) {
  const auto give_up = std::chrono::steady_clock::now() + std::chrono::seconds(30);
  while (std::chrono::steady_clock::now() < give_up) {
    preview.show(frame, std::array{standing_body()}, "alice, 30 Hz");
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    const auto picture = read_bgr_picture(file);
    if (picture && is_so(*picture)) return *picture;
  }
  return {};
}

TEST(Preview, WritesWhatTheCameraSeesWithTheSkeletonOverIt) {
  const std::string file = file_for("alice.png");
  const auto preview = Preview::open(to_file(file));
  ASSERT_TRUE(preview) << preview.error().what;
  const Frame frame{cv::Mat(200, 160, CV_8UC3, cv::Scalar(40, 60, 40)), MonoTime::from_us(1), 1};
  const cv::Mat picture =
      shown(**preview, file, frame, [](const cv::Mat& p) { return p.rows == 200; });
  ASSERT_FALSE(picture.empty()) << (*preview)->trouble();
  EXPECT_EQ(picture.at<cv::Vec3b>(20, 20), cv::Vec3b(40, 60, 40)) << "the room";
  EXPECT_GT(picture.at<cv::Vec3b>(120, 92)[2], 150) << "the left thigh, warm";
  EXPECT_EQ(frame.image.at<cv::Vec3b>(120, 92), cv::Vec3b(40, 60, 40))
      << "the frame itself stays as it is";
}

TEST(Preview, IsAMirrorWhereAskedFor) {
  const std::string file = file_for("mirror.png");
  const auto preview = Preview::open(to_file(file, true));
  ASSERT_TRUE(preview) << preview.error().what;
  Frame frame{cv::Mat(200, 160, CV_8UC3, cv::Scalar(40, 60, 40)), MonoTime::from_us(1), 1};
  frame.image.colRange(0, 10).setTo(cv::Scalar(200, 0, 0));
  const cv::Mat picture =
      shown(**preview, file, frame, [](const cv::Mat& p) { return p.rows == 200; });
  ASSERT_FALSE(picture.empty()) << (*preview)->trouble();
  EXPECT_EQ(picture.at<cv::Vec3b>(20, 155), cv::Vec3b(200, 0, 0));
  EXPECT_GT(picture.at<cv::Vec3b>(120, 159 - 92)[2], 150)
      << "the left thigh, at the left as in a mirror";
}

TEST(Preview, APictureThatOpenCvRefusesEndsThePreviewAlone) {
  const auto preview = Preview::open(to_file(file_for("two.png")));
  ASSERT_TRUE(preview) << preview.error().what;
  const Frame frame{cv::Mat(200, 160, CV_8UC2, cv::Scalar(40, 60)), MonoTime::from_us(1), 1};
  (*preview)->show(frame, std::array{standing_body()}, "two colours");
  while ((*preview)->trouble().empty()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  EXPECT_NE((*preview)->trouble().find("cannot be drawn"), std::string::npos);
}

TEST(Preview, SaysWhatItCannotWrite) {
  const auto nowhere = Preview::open(to_file("/nowhere/at/all.jpg"));
  ASSERT_FALSE(nowhere);
  EXPECT_NE(nowhere.error().what.find("/nowhere/at/all.jpg"), std::string::npos);
  const auto kind = Preview::open(to_file("preview.txt"));
  ASSERT_FALSE(kind);
  EXPECT_NE(kind.error().what.find(".jpg"), std::string::npos);
}

}  // namespace
}  // namespace dance
