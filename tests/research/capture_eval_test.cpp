#include "research/capture/capture_eval.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <opencv2/imgproc.hpp>

#include "producers/camera/files/video_reel.h"
#include "tests/producers/camera/estimator/pose_models.h"
#include "tests/producers/camera/files/written_pictures.h"
#include "tests/test_folder.h"

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

// A man and his mirror image beside him, in pictures that follow each other.
TEST(CaptureEval, TellsSeveralPeopleApartWithHandsAndFaces) {
  SKIP_WITHOUT_POSE_MODELS();
  SKIP_WITHOUT_VIDEO();
  const TestFolder folder("capture-eval-people");
  const auto reel = VideoReel::open(taiji_video());
  ASSERT_TRUE(reel) << reel.error().what;
  std::vector<std::string> files;
  float width = 0.0f;
  for (int i = 0; i < 6; ++i) {
    cv::Mat picture, mirrored, both;
    ASSERT_TRUE((*reel)->step() && (*reel)->read(picture));
    picture = picture(cv::Rect(350, 0, 600, picture.rows)).clone();
    cv::flip(picture, mirrored, 1);
    cv::hconcat(picture, mirrored, both);
    width = static_cast<float>(picture.cols);
    files.push_back(folder.path("couple-" + std::to_string(i) + ".png"));
    write_picture(files.back(), both);
  }
  CaptureEvalOptions options;
  options.people = 2;
  options.sequence_hz = 24.0;
  options.sees_hands = options.sees_face = true;
  const auto run = evaluate_capture(files, options);
  ASSERT_TRUE(run) << run.error().what;
  const auto json = nlohmann::json::parse(capture_eval_json(*run));
  ASSERT_EQ(json.at("frames").size(), files.size());
  for (std::size_t f = 0; f < files.size(); ++f) {
    const auto& people = json["frames"][f].at("people");
    ASSERT_EQ(people.size(), 2u);
    std::size_t hands = 0;
    for (std::size_t person = 0; person < 2; ++person) {
      ASSERT_TRUE(people[person].at("detected"));
      const auto& nose = people[person].at("landmarks_px").at(0);
      EXPECT_EQ(nose[0].get<float>() < width, person == 0) << "frame " << f;
      hands += people[person].at("hands").size();
      EXPECT_FALSE(people[person].at("face").is_null());
    }
    EXPECT_GE(hands, 2u);
  }
  EXPECT_EQ(run->of_several.exchanged, 0u);
  EXPECT_NE(capture_eval_table(*run, options)
                .find("6 frames, 6 with dancer 1 (100.0 %), 6 with dancer 2 (100.0 %)"),
            std::string::npos)
      << capture_eval_table(*run, options);
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
