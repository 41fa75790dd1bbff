#include "producers/camera/stereo/stereo_depth.h"

#include <gtest/gtest.h>

#include "producers/salsa/salsa_dancer.h"
#include "testing/camera/drawn_rig.h"
#include "testing/camera/stereo_dancer.h"
#include "tests/allocation_guard.h"

namespace dance {
namespace {

// One drawn dancer, frame by frame.
class DrawnStage {
 public:
  explicit DrawnStage(const StereoRig& rig = drawn_rig(), SceneEyes eyes = {})
      : scene_(rig, eyes, 5), dancer_(SalsaStyle{}) {}

  void next() {
    Pose pose;
    dancer_.dance_at(Duration::ms(400 * frame_++), pose);
    camera_.aside_m = -pose.p_WH_m.x();
    forward_kinematics(dancer_.skeleton(), pose, body_);
    scene_.draw(body_of(body_, camera_, look_), left, right);
    const auto joints = joints_of(body_, camera_);
    true_m =
        0.5 * (joints[index_of(Landmark::kLeftHip)] + joints[index_of(Landmark::kRightHip)]).z();
    seen = landmarks_of(joints, scene_.rig(), Side::kLeft, errors, random_);
    seen.is_new = frame_ == 1;
  }

  NetworkErrors errors;
  cv::Mat left;
  cv::Mat right;
  BodyLandmarks seen;
  double true_m = 0.0;

 private:
  StereoScene scene_;
  SalsaDancer dancer_;
  StageCamera camera_;
  DancerLook look_;
  BodyFrames body_;
  Random random_{17};
  int frame_ = 0;
};

TEST(StereoDepth, AChildIsSmallAndNotFarAway) {
  DrawnStage stage;
  // The network takes everybody for an adult: here for one who is half as tall again.
  stage.errors.scale = 0.65;
  StereoDepth depth(drawn_rig());
  for (int i = 0; i < 4; ++i) {
    stage.next();
    const DepthHint hint = depth.hint(stage.left, stage.right, stage.seen);
    ASSERT_GE(hint.joints, kLeastJoints);
    EXPECT_NEAR(hint.hips_depth_m, stage.true_m, 0.12);
    EXPECT_NEAR(hint.scale, 0.65, 0.04);
  }
}

TEST(StereoDepth, NobodyThereIsNoDepth) {
  StereoDepth depth(drawn_rig());
  const cv::Mat grey(720, 1280, CV_8UC3, cv::Scalar(90, 90, 90));
  BodyLandmarks nobody;
  EXPECT_EQ(depth.hint(grey, grey, nobody).joints, 0);
  EXPECT_EQ(depth.counters().asked, 0u);
  // Somebody whom no eye can match: a picture without anything.
  DrawnStage stage;
  stage.next();
  EXPECT_EQ(depth.hint(grey, grey, stage.seen).joints, 0);
  EXPECT_EQ(depth.counters().disagreed, 1u);
}

TEST(StereoDepth, LandmarksThatAreNoNumbersDoNoHarm) {
  DrawnStage stage;
  stage.next();
  StereoDepth depth(drawn_rig());
  const float nan = std::numeric_limits<float>::quiet_NaN();
  for (std::size_t i = 0; i < kLandmarkCount; i += 2) stage.seen.image_px[i] = {nan, 1e30f, 0.0f};
  for (std::size_t i = 1; i < kLandmarkCount; i += 4) stage.seen.world_m[i] = {nan, nan, nan};
  const DepthHint hint = depth.hint(stage.left, stage.right, stage.seen);
  EXPECT_TRUE(hint.joints == 0 || std::isfinite(hint.hips_depth_m));
  for (auto& p : stage.seen.world_m) p.setZero();
  EXPECT_EQ(depth.hint(stage.left, stage.right, stage.seen).joints, 0);
}

TEST(StereoDepth, PicturesOfAnotherSizeAreRefusedAndSaidSo) {
  DrawnStage stage;
  stage.next();
  StereoDepth depth(drawn_rig());
  EXPECT_EQ(depth.trouble(), "");
  EXPECT_EQ(depth.hint(stage.left.colRange(0, 640), stage.right, stage.seen).joints, 0);
  EXPECT_EQ(depth.hint(stage.left, cv::Mat(), stage.seen).joints, 0);
  EXPECT_EQ(depth.counters().other_size, 2u);
  EXPECT_NE(depth.trouble().find("1280 x 720"), std::string::npos) << depth.trouble();
  EXPECT_GT(depth.hint(stage.left, stage.right, stage.seen).joints, 0);
}

TEST(StereoDepth, AllocatesNothingOnceItRuns) {
  DrawnStage stage;
  StereoDepth depth(drawn_rig());
  stage.next();
  ASSERT_GT(depth.hint(stage.left, stage.right, stage.seen).joints, 0);
  stage.next();
  AllocationGuard guard;
  const DepthHint hint = depth.hint(stage.left, stage.right, stage.seen);
  const auto allocations = guard.allocations();
  EXPECT_GT(hint.joints, 0);
  // OpenCV's conversion to grey keeps a few small objects on the heap while it runs; what we do
  // keeps none.
  EXPECT_LE(allocations, 8u);
}

TEST(StereoDepth, SwappedEyesAreNoticed) {
  DrawnStage stage;
  StereoDepth depth(drawn_rig());
  stage.next();
  for (int i = 0; i < 200; ++i) depth.hint(stage.right, stage.left, stage.seen);
  EXPECT_LT(depth.counters().hinted, 20u);
  EXPECT_NE(depth.trouble().find("swapped"), std::string::npos) << depth.trouble();
}

TEST(StereoDepth, ABentRigIsNoticedByItsRows) {
  StereoRig bent = drawn_rig();
  bent.R_RL =
      Eigen::AngleAxisd(2.0 / 700.0, Eigen::Vector3d::UnitX()).toRotationMatrix() * bent.R_RL;
  DrawnStage stage;
  StereoDepth depth(bent);
  StereoDepth good(drawn_rig());
  for (int i = 0; i < 3; ++i) {
    stage.next();
    for (int k = 0; k < 30; ++k) {
      depth.hint(stage.left, stage.right, stage.seen);
      good.hint(stage.left, stage.right, stage.seen);
    }
  }
  EXPECT_NEAR(std::abs(depth.row_offset_px()), 2.0, 0.4);
  EXPECT_NE(depth.trouble().find("rows"), std::string::npos);
  EXPECT_LT(std::abs(good.row_offset_px()), 0.3);
  EXPECT_EQ(good.trouble(), "");
}

}  // namespace
}  // namespace dance
