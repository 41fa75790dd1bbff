// Hands and face beside those of the npm package @mediapipe/holistic itself, which runs in Chromium
// on the same pixels.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <opencv2/imgproc.hpp>

#include "producers/camera/estimator/pose_estimator.h"
#include "producers/camera/face/face_tracker.h"
#include "producers/camera/hands/hand_tracker.h"
#include "tests/apps/run_program.h"
#include "tests/producers/camera/estimator/pose_models.h"
#include "tests/producers/camera/files/written_pictures.h"
#include "tests/test_folder.h"

namespace dance {
namespace {

const std::string kPackage = DANCE_SOURCE_DIR "/build/clients/node_modules/@mediapipe/holistic";
const std::string kScript = DANCE_SOURCE_DIR "/tests/clients/camera/run_holistic.py";
constexpr double kVideo_hz = 24000.0 / 1001.0;

std::string why_not() {
  if (!std::filesystem::exists(kPackage + "/holistic.js"))
    return "@mediapipe/holistic is missing; tests/clients/fetch_clients.sh fetches it";
  if (run("chromium --version").exit_code != 0)
    return "chromium is missing; apt-get install chromium";
  const std::string folder = pose_models_folder("");
  if (!HandNetworks::are_in(folder) || !FaceNetworks::are_in(folder))
    return "the networks of hands and face are missing: `dance fetch-models` fetches them";
  return "";
}

class Holistic : public testing::Test {
 protected:
  void SetUp() override {
    SKIP_WITHOUT_POSE_MODELS();
    SKIP_WITHOUT_VIDEO();
    if (const std::string why = why_not(); !why.empty()) GTEST_SKIP() << why;
  }
  // What the original sees, by the pictures' order.
  std::vector<nlohmann::json> original(const std::vector<cv::Mat>& pictures) {
    nlohmann::json frames = nlohmann::json::array();
    for (std::size_t i = 0; i < pictures.size(); ++i) {
      const std::string file = "f" + std::to_string(i) + ".rgba";
      cv::Mat rgba;
      cv::cvtColor(pictures[i], rgba, cv::COLOR_BGR2RGBA);
      std::ofstream(folder_.path(file), std::ios::binary)
          .write(reinterpret_cast<const char*>(rgba.data),
                 static_cast<std::streamsize>(rgba.total() * rgba.elemSize()));
      frames.push_back({{"file", file}, {"width", rgba.cols}, {"height", rgba.rows}});
    }
    std::ofstream(folder_.path("frames.json"))
        << nlohmann::json{{"frames", frames}, {"hz", kVideo_hz}, {"tracks", true}};
    const Finished ran = run("python3 " + kScript + " " + folder_.path("") + " " + kPackage);
    EXPECT_EQ(ran.exit_code, 0) << ran.talk;
    std::vector<nlohmann::json> results;
    std::ifstream file(folder_.path("results.json"));
    for (std::string line; std::getline(file, line);)
      results.push_back(nlohmann::json::parse(line, nullptr, false));
    return results;
  }

  TestFolder folder_{"holistic"};
};

double worst_percent(std::span<const Eigen::Vector3f> points, const nlohmann::json& due,
                     float side_px) {
  double worst = 0.0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector2d at(due[i][0].get<double>(), due[i][1].get<double>());
    worst = std::max(worst, (points[i].head<2>().cast<double>() - at).norm());
  }
  return 100.0 * worst / static_cast<double>(side_px);
}

TEST_F(Holistic, HandsAndFaceAreWithinATenthOfAPercentOfTheirRegion) {
  std::vector<cv::Mat> pictures;
  VideoPictures video(taiji_video());
  cv::Mat image;
  // Both hands are seen here; one came just before.
  for (int i = 0; i < 33 && video.next(image); ++i)
    if (i >= 25) pictures.push_back(image.clone());
  const std::vector<nlohmann::json> due = original(pictures);
  ASSERT_EQ(due.size(), pictures.size());
  const auto estimator = PoseEstimator::open({});
  ASSERT_TRUE(estimator) << estimator.error().what;
  auto networks = HandNetworks::open(EngineKind::kFastest, pose_models_folder(""));
  ASSERT_TRUE(networks) << networks.error().what;
  HandTracker tracker(*networks);
  auto face_networks = FaceNetworks::open(EngineKind::kFastest, pose_models_folder(""));
  ASSERT_TRUE(face_networks) << face_networks.error().what;
  FaceTracker face_tracker(*face_networks);
  int compared = 0;
  double worst = 0.0, worst_face = 0.0;
  for (std::size_t i = 0; i < pictures.size(); ++i) {
    const Frame frame{pictures[i],
                      MonoTime{} + Duration::seconds(1.0 + static_cast<double>(i) / kVideo_hz), i};
    const BodyLandmarks& body = (*estimator)->estimate(frame);
    for (const HandSide side : {HandSide::kLeft, HandSide::kRight}) {
      const HandLandmarks& hand = tracker.look(frame, body, side);
      const nlohmann::json& points = due[i][side == HandSide::kLeft ? "left" : "right"];
      ASSERT_EQ(hand.found, !points.empty()) << "frame " << i;
      if (!hand.found) continue;
      ++compared;
      const double off = worst_percent(hand.image_px, points, hand.region.side_px);
      worst = std::max(worst, off);
      EXPECT_LE(off, 0.1) << "frame " << i;
    }
    const FaceLandmarks& face = face_tracker.look(frame, body);
    ASSERT_EQ(face.found, !due[i]["face"].empty()) << "frame " << i;
    if (!face.found) continue;
    const double off = worst_percent(face.image_px, due[i]["face"], face.region.side_px);
    worst_face = std::max(worst_face, off);
    EXPECT_LE(off, 0.1) << "face of frame " << i;
  }
  EXPECT_GE(compared, 12);
  std::printf("%d hands in %zu pictures: worst point %.4f %% of its region; faces %.4f %%\n",
              compared, pictures.size(), worst, worst_face);
}

}  // namespace
}  // namespace dance
