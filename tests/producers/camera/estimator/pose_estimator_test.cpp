#include "producers/camera/estimator/pose_estimator.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <opencv2/core.hpp>

#include "tests/allocation_guard.h"
#include "tests/producers/camera/estimator/golden_bodies.h"
#include "tests/producers/camera/estimator/pose_models.h"
#include "tests/producers/camera/files/written_pictures.h"

namespace dance {
namespace {

constexpr double kVideo_hz = 24000.0 / 1001.0;

Frame frame_of(const cv::Mat& image, std::size_t number) {
  return {image, MonoTime{} + Duration::seconds(1.0 + static_cast<double>(number) / kVideo_hz),
          number};
}

std::vector<cv::Mat> video_frames(std::size_t count, std::size_t every = 1) {
  VideoPictures video(taiji_video());
  std::vector<cv::Mat> frames;
  cv::Mat image;
  for (std::size_t i = 0; frames.size() < count && video.next(image); ++i)
    if (i % every == 0) frames.push_back(image.clone());
  return frames;
}

std::unique_ptr<PoseEstimator> opened(const EstimatorOptions& options) {
  auto estimator = PoseEstimator::open(options);
  if (!estimator) {
    ADD_FAILURE() << estimator.error().what;
    return nullptr;
  }
  return std::move(*estimator);
}

EstimatorOptions each_for_itself() {
  EstimatorOptions options;
  options.tracks = false;
  return options;
}

TEST(PoseEstimator, SeesInPicturesWhatTheOriginalSees) {
  SKIP_WITHOUT_POSE_MODELS();
  const auto golden = golden_bodies("pictures.txt");
  ASSERT_EQ(golden.size(), 7u);
  const auto estimator = opened(each_for_itself());
  ASSERT_TRUE(estimator);
  VideoPictures video(taiji_video());
  std::size_t compared = 0;
  cv::Mat image;
  for (std::size_t i = 0; i < 401 && video.next(image); ++i) {
    const std::string name = "frame " + std::to_string(i);
    if (!golden.count(name)) continue;
    ++compared;
    expect_like(estimator->estimate(frame_of(image, i)), golden.at(name), 0.1, 0.002, name);
  }
  for (const auto& [name, due] : golden) {
    if (name.rfind("sample ", 0) != 0) continue;
    if (!std::filesystem::exists(opencv_sample(name.substr(7)))) continue;
    const auto picture = read_bgr_picture(opencv_sample(name.substr(7)));
    ASSERT_TRUE(picture) << picture.error().what;
    ++compared;
    expect_like(estimator->estimate(frame_of(*picture, 0)), due, 0.1, 0.002, name);
  }
  if (compared == 0) GTEST_SKIP() << "neither " << taiji_video() << " nor opencv-doc is here";
}

TEST(PoseEstimator, OpenCvSeesTheSame) {
  SKIP_WITHOUT_POSE_MODELS();
  SKIP_WITHOUT_VIDEO();
  EstimatorOptions options = each_for_itself();
  options.engine = EngineKind::kOpenCv;
  const auto estimator = opened(options);
  ASSERT_TRUE(estimator);
  const auto frames = video_frames(1);
  const auto golden = golden_bodies("video_tracked.txt");
  expect_like(estimator->estimate(frame_of(frames[0], 0)), golden.at("frame 0"), 0.1, 0.002,
              "frame 0");
}

TEST(PoseEstimator, FollowsAVideoAsTheOriginalDoes) {
  SKIP_WITHOUT_POSE_MODELS();
  SKIP_WITHOUT_VIDEO();
  const auto golden = golden_bodies("video_tracked.txt");
  ASSERT_EQ(golden.size(), 7u);
  const auto estimator = opened({});
  ASSERT_TRUE(estimator);
  VideoPictures video(taiji_video());
  cv::Mat image;
  std::size_t compared = 0;
  for (std::size_t i = 0; i < 150 && video.next(image); ++i) {
    const BodyLandmarks& body = estimator->estimate(frame_of(image, i));
    ASSERT_TRUE(body.found) << "frame " << i;
    EXPECT_EQ(body.is_new, i == 0);
    const auto due = golden.find("frame " + std::to_string(i));
    if (due == golden.end()) continue;
    ++compared;
    expect_like(body, due->second, 0.2, 0.005, due->first);
  }
  EXPECT_EQ(compared, golden.size());
  EXPECT_EQ(estimator->counters().searches, 1u);
}

TEST(PoseEstimator, GivesTheUnfilteredPointsToo) {
  SKIP_WITHOUT_POSE_MODELS();
  SKIP_WITHOUT_VIDEO();
  const auto filtered = opened({});
  EstimatorOptions raw;
  raw.smooths = false;
  const auto unfiltered = opened(raw);
  ASSERT_TRUE(filtered && unfiltered);
  const auto frames = video_frames(12);
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const BodyLandmarks& body = filtered->estimate(frame_of(frames[i], i));
    const BodyLandmarks& plain = unfiltered->estimate(frame_of(frames[i], i));
    for (std::size_t k = 0; k < kLandmarkCount; ++k) {
      EXPECT_EQ(filtered->unfiltered().image_px[k], plain.image_px[k]);
      EXPECT_EQ(filtered->unfiltered().world_m[k], plain.world_m[k]);
    }
    if (i == 11) {
      EXPECT_NE(body.world_m[0], plain.world_m[0]);
    }
  }
}

TEST(PoseEstimator, LosesADancerInTheDarkAndFindsThemAgain) {
  SKIP_WITHOUT_POSE_MODELS();
  SKIP_WITHOUT_VIDEO();
  const auto estimator = opened({});
  ASSERT_TRUE(estimator);
  const auto frames = video_frames(10);
  const cv::Mat black(frames[0].size(), CV_8UC3, cv::Scalar::all(0));
  std::size_t number = 0;
  for (; number < 5; ++number)
    EXPECT_TRUE(estimator->estimate(frame_of(frames[number], number)).found);
  const std::size_t dark = 120;  // five seconds
  for (std::size_t i = 0; i < dark; ++i, ++number)
    EXPECT_FALSE(estimator->estimate(frame_of(black, number)).found) << "dark frame " << i;
  EXPECT_EQ(estimator->counters().losses, 1u);
  // Two seconds of every frame, then ten times a second.
  EXPECT_GE(estimator->counters().searches, 40u);
  EXPECT_LE(estimator->counters().searches, 1u + 48u + 31u);
  std::size_t waited = 0;
  while (waited < 5 && !estimator->estimate(frame_of(frames[5], number++)).found) ++waited;
  EXPECT_LE(waited, 3u);
  const BodyLandmarks& again = estimator->estimate(frame_of(frames[6], number));
  EXPECT_TRUE(again.found);
  EXPECT_FALSE(again.is_new);
  EXPECT_LE(estimator->counters().losses, 1u);
}

TEST(PoseEstimator, FollowsWhomOnePointsAt) {
  SKIP_WITHOUT_POSE_MODELS();
  SKIP_WITHOUT_VIDEO();
  const auto estimator = opened({});
  ASSERT_TRUE(estimator);
  const auto frames = video_frames(12);
  constexpr int kHalf_px = 640;
  const auto pair_of = [&](std::size_t i) {
    const cv::Mat one = frames[i](cv::Rect(340, 0, kHalf_px, frames[i].rows));
    cv::Mat both;
    cv::hconcat(one, one, both);
    return both;
  };
  for (const float place : {0.25f, 0.75f}) {
    estimator->follow(place * 2.0f * kHalf_px, 300.0f);
    for (std::size_t i = 0; i < frames.size(); ++i) {
      const BodyLandmarks& body = estimator->estimate(frame_of(pair_of(i), i));
      ASSERT_TRUE(body.found) << "frame " << i;
      EXPECT_EQ(body.is_new, i == 0);
      const float middle_px = body.image(Landmark::kLeftHip).x();
      EXPECT_EQ(middle_px > kHalf_px, place > 0.5f) << "frame " << i;
    }
  }
}

// A strip with another man in it goes from left to right across the picture, in front of the
// dancer. Where the hips of the one who is followed are in the end.
float hips_after_passing(PoseEstimator& estimator, const std::vector<cv::Mat>& frames) {
  constexpr int kDancer_px = 640, kHalf_px = 130, kStep_px = 12;
  cv::Mat passer;
  cv::flip(frames[0](cv::Rect(kDancer_px - kHalf_px, 0, 2 * kHalf_px, frames[0].rows)), passer, 1);
  estimator.follow(kDancer_px, 400.0f);
  float hips_px = 0.0f;
  std::size_t number = 0;
  for (int x = 0; x + 2 * kHalf_px < frames[0].cols; x += kStep_px, ++number) {
    cv::Mat picture = frames[number / 4 % frames.size()].clone();
    passer.copyTo(picture(cv::Rect(x, 0, passer.cols, passer.rows)));
    const BodyLandmarks& body = estimator.estimate(frame_of(picture, number));
    if (body.found)
      hips_px = 0.5f * (body.image(Landmark::kLeftHip) + body.image(Landmark::kRightHip)).x();
  }
  return hips_px;
}

TEST(PoseEstimator, WhoWalksPastInFrontDoesNotTakeTheDancersPlace) {
  SKIP_WITHOUT_POSE_MODELS();
  SKIP_WITHOUT_VIDEO();
  const auto frames = video_frames(24);
  const auto watchful = opened({});
  ASSERT_TRUE(watchful);
  EXPECT_NEAR(hips_after_passing(*watchful, frames), 650.0f, 50.0f);
  EXPECT_EQ(watchful->counters().exchanged, 1u);
  // What it would be without looking at the others.
  EstimatorOptions options;
  options.follow.watches_others = false;
  const auto blind = opened(options);
  ASSERT_TRUE(blind);
  EXPECT_GT(hips_after_passing(*blind, frames), 900.0f);
}

TEST(PoseEstimator, AllocatesNothingOfOursOncePeopleAreFollowed) {
  SKIP_WITHOUT_POSE_MODELS();
  SKIP_WITHOUT_VIDEO();
  if (!kHasXnnpack) GTEST_SKIP() << "OpenCV's networks allocate as they like";
  const auto estimator = opened({});
  ASSERT_TRUE(estimator);
  const auto frames = video_frames(8);
  for (std::size_t i = 0; i < 4; ++i) estimator->estimate(frame_of(frames[i], i));
  std::array<Frame, 4> rest;
  for (std::size_t i = 0; i < rest.size(); ++i) rest[i] = frame_of(frames[4 + i], 4 + i);
  AllocationGuard guard;
  bool is_found = true;
  for (const Frame& frame : rest) is_found = estimator->estimate(frame).found && is_found;
  EXPECT_EQ(guard.allocations(), 0u);
  EXPECT_TRUE(is_found);
}

TEST(PoseEstimator, WhatIsNoPictureHasNobody) {
  SKIP_WITHOUT_POSE_MODELS();
  const auto estimator = opened({});
  ASSERT_TRUE(estimator);
  EXPECT_FALSE(estimator->estimate(frame_of(cv::Mat(), 0)).found);
  EXPECT_FALSE(estimator->estimate(frame_of(cv::Mat(10, 10, CV_8UC1), 1)).found);
  EXPECT_EQ(estimator->counters().unusable, 2u);
  EXPECT_FALSE(estimator->estimate(frame_of(cv::Mat(1, 1, CV_8UC3, cv::Scalar::all(9)), 2)).found);
}

TEST(PoseEstimator, MissingNetworksAreNamedWithTheirCure) {
  EstimatorOptions options;
  options.models_folder = "/nowhere";
  const auto estimator = PoseEstimator::open(options);
  ASSERT_FALSE(estimator);
  EXPECT_EQ(estimator.error().what,
            "/nowhere/pose_detection.tflite: no such file; `dance fetch-models` fetches it");
}

TEST(PoseEstimator, DamagedAndMistakenNetworksAreNamed) {
  SKIP_WITHOUT_POSE_MODELS();
  namespace fs = std::filesystem;
  const fs::path from = pose_models_folder("");
  const fs::path folder = fs::path(testing::TempDir()) / "dance_damaged_pose_models";
  fs::remove_all(folder);
  fs::create_directories(folder);
  fs::copy(from / "pose_detection.tflite", folder / "pose_detection.tflite");
  fs::copy(from / "pose_detection.tflite", folder / "pose_landmark_lite.tflite");
  fs::copy(from / "pose_landmark_full.tflite", folder / "pose_landmark_full.tflite");
  fs::resize_file(folder / "pose_landmark_full.tflite", 1'000'000);
  EstimatorOptions options;
  options.models_folder = folder;
  const auto damaged = PoseEstimator::open(options);
  ASSERT_FALSE(damaged);
  EXPECT_NE(damaged.error().what.find("pose_landmark_full.tflite: "), std::string::npos)
      << damaged.error().what;
  options.model = PoseNetworkModel::kLite;
  const auto mistaken = PoseEstimator::open(options);
  ASSERT_FALSE(mistaken);
  EXPECT_NE(mistaken.error().what.find("is not a network that finds the points of a body"),
            std::string::npos)
      << mistaken.error().what;
  fs::remove_all(folder);
}

}  // namespace
}  // namespace dance
