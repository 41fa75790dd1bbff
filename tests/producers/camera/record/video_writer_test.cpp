#include "producers/camera/record/video_writer.h"

#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <thread>

#include "tests/producers/camera/files/written_pictures.h"

namespace dance {
namespace {

std::string video_for(const std::string& name) {
  const std::string folder = std::string(DANCE_BINARY_DIR) + "/video-writer-test/" + name;
  std::filesystem::remove_all(folder);
  std::filesystem::create_directories(folder);
  return folder + "/video.mkv";
}

TEST(VideoWriter, KeepsThePicturesAndWhenTheyWereTaken) {
  SKIP_WITHOUT_MEDIA();
  const std::string path = video_for("ten");
  {
    const auto writer = VideoWriter::create(path, 30.0);
    ASSERT_TRUE(writer) << writer.error().what;
    for (int i = 0; i < 10; ++i) {
      const Frame frame{cv::Mat(120, 160, CV_8UC3, cv::Scalar::all(20 * i + 10)),
                        MonoTime::from_us(1'000'000 + i * 33'333), static_cast<std::uint64_t>(i)};
      (*writer)->add(frame);
      while ((*writer)->written() <= static_cast<std::uint64_t>(i) && (*writer)->trouble().empty())
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    (*writer)->finish();
    EXPECT_EQ((*writer)->trouble(), "");
    EXPECT_EQ((*writer)->written(), 10u);
    EXPECT_EQ((*writer)->left_out(), 0u);
  }
  VideoPictures video(path);
  ASSERT_TRUE(video.is_open());
  cv::Mat picture;
  int count = 0;
  for (; video.next(picture); ++count)
    EXPECT_NEAR(picture.at<cv::Vec3b>(60, 80)[1], 20 * count + 10, 6) << "picture " << count;
  EXPECT_EQ(count, 10);
  std::ifstream table(path + ".tsv");
  std::string head;
  std::getline(table, head);
  long long number = 0;
  long long time_us = 0;
  int rows = 0;
  for (; table >> number >> time_us; ++rows) {
    EXPECT_EQ(number, rows);
    EXPECT_EQ(time_us, 1'000'000 + rows * 33'333);
  }
  EXPECT_EQ(rows, 10);
}

TEST(VideoWriter, NeverHoldsTheCameraUp) {
  SKIP_WITHOUT_MEDIA();
  const std::string path = video_for("flood");
  const auto writer = VideoWriter::create(path, 30.0);
  ASSERT_TRUE(writer) << writer.error().what;
  const Frame frame{cv::Mat(720, 1280, CV_8UC3, cv::Scalar::all(99)), MonoTime::from_us(5), 0};
  for (int i = 0; i < 60; ++i) (*writer)->add(frame);
  (*writer)->finish();
  EXPECT_EQ((*writer)->written() + (*writer)->left_out(), 60u) << "what was not written is counted";
  EXPECT_GE((*writer)->written(), 1u);
}

TEST(VideoWriter, LeavesOutAndCountsWhatHasAnotherSize) {
  SKIP_WITHOUT_MEDIA();
  const std::string path = video_for("sizes");
  const auto writer = VideoWriter::create(path, 0.0);  // a camera that does not say its rate
  ASSERT_TRUE(writer) << writer.error().what;
  const Frame small{cv::Mat(120, 160, CV_8UC3, cv::Scalar::all(50)), MonoTime::from_us(5), 0};
  const Frame large{cv::Mat(240, 320, CV_8UC3, cv::Scalar::all(90)), MonoTime::from_us(6), 1};
  std::uint64_t added = 0;
  for (const Frame* frame : {&small, &large, &large, &small}) {
    (*writer)->add(*frame);
    ++added;
    while ((*writer)->written() + (*writer)->left_out() < added)
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  (*writer)->finish();
  EXPECT_EQ((*writer)->written(), 2u);
  EXPECT_EQ((*writer)->left_out(), 2u);
  EXPECT_NE((*writer)->trouble().find("320x240"), std::string::npos) << (*writer)->trouble();
  VideoPictures video(path);
  EXPECT_NEAR(video.hz(), 30.0, 0.1);
  int count = 0;
  for (cv::Mat picture; video.next(picture); ++count) EXPECT_EQ(picture.size(), small.image.size());
  EXPECT_EQ(count, 2);
}

TEST(VideoWriter, APictureOfDeeperColoursEndsTheVideoAlone) {
  SKIP_WITHOUT_MEDIA();
  const auto writer = VideoWriter::create(video_for("deep"), 30.0);
  ASSERT_TRUE(writer) << writer.error().what;
  (*writer)->add({cv::Mat(120, 160, CV_8UC3, cv::Scalar::all(50)), MonoTime::from_us(5), 0});
  while ((*writer)->written() == 0) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  (*writer)->add({cv::Mat(120, 160, CV_16UC3, cv::Scalar::all(50)), MonoTime::from_us(6), 1});
  (*writer)->finish();
  EXPECT_EQ((*writer)->written(), 1u);
  EXPECT_NE((*writer)->trouble().find("deep/video.mkv"), std::string::npos);
}

TEST(VideoWriter, SaysWhatItCannotWrite) {
  const auto writer = VideoWriter::create("/nowhere/at/all/video.mkv", 30.0);
  ASSERT_FALSE(writer);
  EXPECT_NE(writer.error().what.find("/nowhere/at/all/video.mkv"), std::string::npos);
}

}  // namespace
}  // namespace dance
