#include "producers/camera/face/face_tracker.h"

#include <gtest/gtest.h>

#include <fstream>

#include "producers/camera/estimator/pose_estimator.h"
#include "producers/camera/face/face_region.h"
#include "producers/camera/region/picture_region.h"
#include "tests/producers/camera/estimator/pose_models.h"
#include "tests/producers/camera/files/written_pictures.h"

namespace dance {
namespace {

using Eigen::Vector2f;

std::vector<Vector2f> golden_face() {
  std::ifstream file(DANCE_SOURCE_DIR "/tests/producers/camera/face/golden/frame_25.txt");
  std::vector<Vector2f> points;
  for (std::string line; std::getline(file, line);)
    if (!line.empty() && line[0] != '#') {
      Vector2f& p = points.emplace_back();
      std::sscanf(line.c_str(), "%f %f", &p.x(), &p.y());  // NOLINT(cert-err34-c)
    }
  return points;
}

TEST(FaceTracker, SeesAFaceAsTheOriginalDoesAndNoneInTheDark) {
  SKIP_WITHOUT_POSE_MODELS();
  SKIP_WITHOUT_VIDEO();
  if (!FaceNetworks::are_in(pose_models_folder("")))
    GTEST_SKIP() << "the networks of faces are missing: `dance fetch-models` fetches them";
  const std::vector<Vector2f> golden = golden_face();
  ASSERT_EQ(golden.size(), kFacePointCount);
  const auto estimator = PoseEstimator::open({});
  auto networks = FaceNetworks::open(EngineKind::kFastest, pose_models_folder(""));
  ASSERT_TRUE(estimator && networks);
  FaceTracker tracker(*networks);
  VideoPictures video(taiji_video());
  cv::Mat picture;
  for (int i = 0; i <= 25; ++i) ASSERT_TRUE(video.next(picture));
  Frame frame{picture, MonoTime{} + Duration::s(1), 0};
  const BodyLandmarks body = (*estimator)->estimate(frame);
  const FaceLandmarks seen = tracker.look(frame, body);
  ASSERT_TRUE(seen.found);
  for (std::size_t i = 0; i < kFacePointCount; ++i) {
    const float off = (seen.image_px[i].head<2>() - golden[i]).norm();
    EXPECT_LE(100.0f * off / seen.region.side_px, 0.1f) << "point " << i;
  }
  EXPECT_FALSE(tracker.look(frame, {}).found);
  frame.image = cv::Mat(picture.size(), CV_8UC3, cv::Scalar::all(0));
  EXPECT_FALSE(tracker.look(frame, body).found);
  frame.image = cv::Mat();
  EXPECT_FALSE(tracker.look(frame, body).found);
}

TEST(FaceTracker, AMissingNetworkIsNamedWithItsCure) {
  const auto networks = FaceNetworks::open(EngineKind::kOpenCv, "/nonexistent");
  ASSERT_FALSE(networks);
  EXPECT_NE(networks.error().what.find("face_detection_short_range.tflite"), std::string::npos);
  EXPECT_NE(networks.error().what.find("dance fetch-models"), std::string::npos);
}

TEST(FaceRegion, LiesAboutTheBodysFaceAndTurnsWithItsEyes) {
  BodyLandmarks body;
  body.found = true;
  for (auto& p : body.image_px) p = {100.0f, 100.0f, 0.0f};
  body.image_px[index_of(Landmark::kLeftEye)] = {110.0f, 100.0f, 0.0f};
  body.image_px[index_of(Landmark::kRightEye)] = {90.0f, 100.0f, 0.0f};
  const auto region = face_region_of(body);
  ASSERT_TRUE(region);
  EXPECT_NEAR(region->turn_rad, 0.0f, 1e-6f);
  EXPECT_NEAR(region->side_px, 60.0f, 1e-3f);
  EXPECT_NEAR(region->centre_x_px, 100.0f, 1e-3f);
  body.image_px[index_of(Landmark::kLeftEye)] = {100.0f, 110.0f, 0.0f};
  body.image_px[index_of(Landmark::kRightEye)] = {100.0f, 90.0f, 0.0f};
  EXPECT_NEAR(face_region_of(body)->turn_rad, 1.5708f, 1e-3f);
  body.found = false;
  EXPECT_FALSE(face_region_of(body));
}

}  // namespace
}  // namespace dance
