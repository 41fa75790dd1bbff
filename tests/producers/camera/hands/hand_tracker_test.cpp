#include "producers/camera/hands/hand_tracker.h"

#include <gtest/gtest.h>

#include <fstream>
#include <map>
#include <sstream>

#include "producers/camera/estimator/pose_estimator.h"
#include "tests/producers/camera/estimator/pose_models.h"
#include "tests/producers/camera/files/written_pictures.h"

#define SKIP_WITHOUT_HANDS()                         \
  SKIP_WITHOUT_POSE_MODELS();                        \
  SKIP_WITHOUT_VIDEO();                              \
  if (!HandNetworks::are_in(pose_models_folder(""))) \
  GTEST_SKIP() << "the networks of hands are missing: `dance fetch-models` fetches them"

namespace dance {
namespace {

constexpr double kHandsVideo_hz = 24000.0 / 1001.0;
constexpr int kFirst = 25, kEnd = 33;  // both hands are seen

Frame frame_of(const cv::Mat& image, int number) {
  return {image, MonoTime{} + Duration::seconds(1.0 + number / kHandsVideo_hz),
          static_cast<std::uint64_t>(number)};
}

std::vector<cv::Mat> pictures() {
  std::vector<cv::Mat> found;
  VideoPictures video(taiji_video());
  cv::Mat image;
  for (int i = 0; i < kEnd && video.next(image); ++i)
    if (i >= kFirst) found.push_back(image.clone());
  return found;
}

// What the original sees: by "frame 3 left".
std::map<std::string, std::vector<Eigen::Vector2f>> golden_hands() {
  std::ifstream file(DANCE_SOURCE_DIR "/tests/producers/camera/hands/golden/video_tracked.txt");
  std::map<std::string, std::vector<Eigen::Vector2f>> hands;
  std::vector<Eigen::Vector2f>* hand = nullptr;
  for (std::string line; std::getline(file, line);) {
    if (line.empty() || line[0] == '#') continue;
    if (line[0] == 'f') {
      hand = &hands[line];
    } else if (hand) {
      Eigen::Vector2f& p = hand->emplace_back();
      std::istringstream(line) >> p.x() >> p.y();
    }
  }
  return hands;
}

struct Seer {
  std::unique_ptr<PoseEstimator> estimator;
  std::unique_ptr<HandNetworks> networks;
  std::unique_ptr<HandTracker> tracker;
};

Seer open_seer() {
  Seer seer;
  auto estimator = PoseEstimator::open({});
  auto networks = HandNetworks::open(EngineKind::kFastest, pose_models_folder(""));
  EXPECT_TRUE(estimator && networks);
  if (!estimator || !networks) return seer;
  seer.estimator = std::move(*estimator);
  seer.networks = std::make_unique<HandNetworks>(std::move(*networks));
  seer.tracker = std::make_unique<HandTracker>(*seer.networks);
  return seer;
}

TEST(HandTracker, FollowsHandsAsTheOriginalDoes) {
  SKIP_WITHOUT_HANDS();
  const auto golden = golden_hands();
  ASSERT_GE(golden.size(), 12u);
  Seer seer = open_seer();
  ASSERT_TRUE(seer.tracker);
  int number = 0, compared = 0;
  for (const cv::Mat& picture : pictures()) {
    const Frame frame = frame_of(picture, number);
    const BodyLandmarks& body = seer.estimator->estimate(frame);
    for (const HandSide side : {HandSide::kLeft, HandSide::kRight}) {
      const std::string name =
          "frame " + std::to_string(number) + (side == HandSide::kLeft ? " left" : " right");
      const HandLandmarks& hand = seer.tracker->look(frame, body, side);
      const auto due = golden.find(name);
      ASSERT_EQ(hand.found, due != golden.end()) << name;
      if (!hand.found) continue;
      ++compared;
      ASSERT_EQ(due->second.size(), kHandPointCount);
      for (std::size_t i = 0; i < kHandPointCount; ++i) {
        const float off = (hand.image_px[i].head<2>() - due->second[i]).norm();
        EXPECT_LE(100.0f * off / hand.region.side_px, 0.2f) << name << " point " << i;
      }
    }
    ++number;
  }
  EXPECT_EQ(compared, static_cast<int>(golden.size()));
}

TEST(HandTracker, SeesNoHandWhereThereIsNoBodyAndInTheDark) {
  SKIP_WITHOUT_HANDS();
  Seer seer = open_seer();
  ASSERT_TRUE(seer.tracker);
  const cv::Mat picture = pictures().front();
  const Frame frame = frame_of(picture, 0);
  const BodyLandmarks body = seer.estimator->estimate(frame);
  EXPECT_TRUE(seer.tracker->look(frame, body, HandSide::kLeft).found);
  EXPECT_FALSE(seer.tracker->look(frame, {}, HandSide::kLeft).found);
  const cv::Mat black(picture.size(), CV_8UC3, cv::Scalar::all(0));
  EXPECT_FALSE(seer.tracker->look(frame_of(black, 1), body, HandSide::kLeft).found);
  EXPECT_FALSE(seer.tracker->look(frame_of({}, 2), body, HandSide::kLeft).found);
  EXPECT_TRUE(seer.tracker->look(frame_of(picture, 3), body, HandSide::kLeft).found);
}

TEST(HandTracker, AMissingNetworkIsNamedWithItsCure) {
  const auto networks = HandNetworks::open(EngineKind::kOpenCv, "/nonexistent");
  ASSERT_FALSE(networks);
  EXPECT_NE(networks.error().what.find("hand_recrop.tflite"), std::string::npos);
  EXPECT_NE(networks.error().what.find("dance fetch-models"), std::string::npos);
  EXPECT_FALSE(HandNetworks::are_in("/nonexistent"));
}

}  // namespace
}  // namespace dance
