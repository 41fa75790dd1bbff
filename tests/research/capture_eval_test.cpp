#include "research/capture/capture_eval.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "tests/producers/camera/estimator/pose_models.h"
#include "tests/producers/camera/files/written_pictures.h"

namespace dance {
namespace {

TEST(CaptureEval, GivesEveryFrameItsPoints) {
  SKIP_WITHOUT_POSE_MODELS();
  SKIP_WITHOUT_VIDEO();
  const std::string dark = testing::TempDir() + "/dance_dark.png";
  write_picture(dark, cv::Mat(48, 64, CV_8UC3, cv::Scalar::all(0)));
  CaptureEvalOptions options;
  options.every = 12;
  options.compares_engines = kHasXnnpack;
  const auto run = evaluate_capture({dark, taiji_video()}, options);
  ASSERT_TRUE(run) << run.error().what;
  const auto json = nlohmann::json::parse(capture_eval_json(*run));
  const auto& frames = json.at("frames");
  ASSERT_EQ(frames.size(), 36u);
  EXPECT_EQ(frames[0].at("name"), "dance_dark.png");
  EXPECT_EQ(frames[0].at("detected"), false);
  EXPECT_TRUE(frames[0].at("landmarks_px").empty());
  EXPECT_EQ(frames[2].at("name"), "taiji.mp4#12");
  for (std::size_t i = 1; i < frames.size(); ++i) {
    EXPECT_EQ(frames[i].at("detected"), true);
    ASSERT_EQ(frames[i].at("landmarks_px").size(), kLandmarkCount);
    ASSERT_EQ(frames[i].at("world_m").size(), kLandmarkCount);
    EXPECT_EQ(frames[i].at("landmarks_px")[0].size(), 4u);
    EXPECT_EQ(frames[i].at("world_m")[0].size(), 3u);
  }
  EXPECT_GT(json.at("ms_per_frame").get<double>(), 0.0);
  if (kHasXnnpack) {
    EXPECT_EQ(run->engines.regions, 35u);
    EXPECT_LT(run->engines.worst_point_px, 0.05);
    EXPECT_LT(run->engines.worst_world_m, 1e-3);
  }
  EXPECT_NE(capture_eval_table(*run, options).find("36 frames, 35 with a dancer"),
            std::string::npos);
  std::filesystem::remove(dark);
}

TEST(CaptureEval, NamesWhatItCannotRead) {
  SKIP_WITHOUT_POSE_MODELS();
  const auto run = evaluate_capture({"/nowhere.mp4"}, {});
  ASSERT_FALSE(run);
  EXPECT_NE(run.error().what.find("/nowhere.mp4: there is no such file"), std::string::npos)
      << run.error().what;
}

}  // namespace
}  // namespace dance
