#include "producers/camera/extras/hands_and_face.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <vector>

#include "producers/camera/estimator/pose_estimator.h"
#include "tests/producers/camera/estimator/pose_models.h"
#include "tests/producers/camera/files/written_pictures.h"

namespace dance {
namespace {

class Sink : public CaptureSink {
 public:
  void capture(const GuestId&, Pose&, MonoTime) override { ++poses; }
  void capture(const GuestId&, const Hands& seen) override { hands.push_back(seen); }
  void capture(const GuestId&, const TimedSkeleton&) override {}
  void capture_face(const GuestId&, const Face& seen) override { faces.push_back(seen); }

  std::vector<Hands> hands;
  std::vector<Face> faces;
  int poses = 0;
};

constexpr std::uint32_t kLeft = 0x7fff, kRight = 0x7fffu << 15;

// Pictures in which both hands are seen, through estimator and HandsAndFace.
class HandsInPictures : public testing::Test {
 protected:
  void SetUp() override {
    SKIP_WITHOUT_POSE_MODELS();
    SKIP_WITHOUT_VIDEO();
    const std::string folder = pose_models_folder("");
    if (!HandNetworks::are_in(folder))
      GTEST_SKIP() << "the networks of hands are missing: `dance fetch-models` fetches them";
    auto networks = HandNetworks::open(EngineKind::kFastest, folder);
    auto estimator = PoseEstimator::open({});
    ASSERT_TRUE(networks && estimator);
    extras_.hands.emplace(std::move(*networks));
    estimator_ = std::move(*estimator);
    VideoPictures video(taiji_video());
    cv::Mat image;
    for (int i = 0; i < 31 && video.next(image); ++i)
      if (i >= 25) pictures_.push_back(image.clone());
  }
  void look(HandsAndFace& seen, const cv::Mat& picture, std::uint32_t number) {
    const Frame frame{picture, MonoTime{} + Duration::s(1) + Duration::ms(33 * number), number};
    const BodyLandmarks& body = estimator_->estimate(frame);
    Pose pose;
    pose.sequence = 100 + number;
    pose.clock_id = 7;
    pose.capture_time = frame.capture_time;
    seen.steady_wrists(pose);
    const Eigen::Matrix3f R_WC = Eigen::Vector3f(1.0f, -1.0f, -1.0f).asDiagonal();
    seen.look({frame, body, pose, R_WC, guest_, sink_});
  }

  Extras extras_;
  std::unique_ptr<PoseEstimator> estimator_;
  std::vector<cv::Mat> pictures_;
  GuestId guest_;
  Sink sink_;
};

TEST_F(HandsInPictures, ArePublishedWithTheirPose) {
  HandsAndFace seen(extras_, {});
  for (std::uint32_t i = 0; i < 6; ++i) look(seen, pictures_[i], i);
  ASSERT_EQ(sink_.hands.size(), 6u);
  for (std::uint32_t i = 0; i < 6; ++i) {
    const Hands& hands = sink_.hands[i];
    EXPECT_EQ(hands.sequence, 100 + i);
    EXPECT_EQ(hands.clock_id, 7u);
    EXPECT_EQ(hands.capture_time, MonoTime{} + Duration::s(1) + Duration::ms(33 * i));
    EXPECT_EQ(hands.presence, kLeft | kRight);
    EXPECT_TRUE(is_valid(hands));
  }
  EXPECT_EQ(sink_.poses, 0);
}

TEST_F(HandsInPictures, AreThoseOfTheOtherSideInAMirror) {
  HandsAndFace straight(extras_, {}), mirrored(extras_, {1.0, true});
  look(straight, pictures_[0], 0);
  estimator_->reset();
  look(mirrored, pictures_[0], 0);
  ASSERT_EQ(sink_.hands.size(), 2u);
  Hands back = sink_.hands[1];
  mirror(back);
  for (std::size_t i = 0; i < kFingerBoneCount; ++i)
    EXPECT_LT(back.R_PB[i].angularDistance(sink_.hands[0].R_PB[i]), 1e-3f);
}

TEST_F(HandsInPictures, RelaxInTheDarkAndThenNothingIsSaid) {
  HandsAndFace seen(extras_, {});
  look(seen, pictures_[0], 0);
  const cv::Mat black(pictures_[0].size(), CV_8UC3, cv::Scalar::all(0));
  for (std::uint32_t i = 1; i < 60; ++i) look(seen, black, i);
  const Hands& last = sink_.hands.back();
  EXPECT_EQ(last.presence, 0u);
  for (const auto& R : last.R_PB)
    EXPECT_EQ(R.angularDistance(Eigen::Quaternionf::Identity()), 0.0f);
  EXPECT_LT(sink_.hands.size(), 50u);
  EXPECT_GT(sink_.hands.size(), 30u);
}

TEST_F(HandsInPictures, ASlowMachineLooksAtThemByTurns) {
  HandsAndFace seen(extras_, {});
  // Pictures that take longer than the time between them.
  MonoTime now = MonoTime{} + Duration::s(1);
  for (int i = 0; i < 200 && extras_.load.step() == LoadStep::kAll; ++i) {
    now = now + Duration::ms(50);
    extras_.load.add(Duration::ms(49), Duration::ms(50), now);
  }
  ASSERT_EQ(extras_.load.step(), LoadStep::kAlternating);
  for (std::uint32_t i = 0; i < 4; ++i) look(seen, pictures_[i], i);
  ASSERT_EQ(sink_.hands.size(), 4u);
  EXPECT_EQ(sink_.hands[0].presence, kLeft);
  EXPECT_EQ(sink_.hands[1].presence, kLeft | kRight);
  // A hand that is not looked for keeps its fingers until its next turn.
  for (std::size_t i = 0; i < 15; ++i)
    EXPECT_EQ(sink_.hands[1].R_PB[i].coeffs(), sink_.hands[0].R_PB[i].coeffs());
}

TEST_F(HandsInPictures, NoFaceIsPublishedUnlessItIsWantedAndThenItIs) {
  HandsAndFace without(extras_, {});
  look(without, pictures_[0], 0);
  EXPECT_TRUE(sink_.faces.empty());
  if (!FaceNetworks::are_in(pose_models_folder("")))
    GTEST_SKIP() << "the networks of faces are missing: `dance fetch-models` fetches them";
  auto networks = FaceNetworks::open(EngineKind::kFastest, pose_models_folder(""));
  ASSERT_TRUE(networks);
  extras_.face.emplace(std::move(*networks));
  HandsAndFace seen(extras_, {});
  for (std::uint32_t i = 0; i < 3; ++i) look(seen, pictures_[i], 1 + i);
  ASSERT_EQ(sink_.faces.size(), 3u);
  const Face& face = sink_.faces.back();
  EXPECT_EQ(face.presence, kFaceSeen);
  EXPECT_EQ(face.sequence, 103u);
  EXPECT_TRUE(is_valid(face));
  // The face at rest is not known yet: nothing is shown.
  for (const float weight : face.weight) EXPECT_EQ(weight, 0.0f);
}

TEST(HandsAndFace, WithoutNetworksItDoesNothing) {
  Extras extras;
  HandsAndFace seen(extras, {});
  Pose pose;
  const Pose before = pose;
  seen.steady_wrists(pose);
  EXPECT_EQ(pose.R_PB[9].coeffs(), before.R_PB[9].coeffs());
  Sink sink;
  const Frame frame;
  const BodyLandmarks body;
  seen.look({frame, body, pose, Eigen::Matrix3f::Identity(), GuestId(), sink});
  EXPECT_TRUE(sink.hands.empty());
}

}  // namespace
}  // namespace dance
