#include "producers/replay/clip_dancer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "core/pose/interpolate.h"

namespace dance {
namespace {

constexpr double kHz = 60.0;

// Six seconds of walking along +X at half a metre a second, the head turning steadily.
std::shared_ptr<const MotionClip> walk(std::size_t frames = 361) {
  auto clip = std::make_shared<MotionClip>();
  clip->skeleton = average_skeleton();
  clip->frame_hz = kHz;
  clip->frames.resize(frames);
  for (std::size_t f = 0; f < frames; ++f) {
    const float t_s = static_cast<float>(f) / static_cast<float>(kHz);
    clip->frames[f].p_WH_m = Eigen::Vector3f(0.5f * t_s, 0.95f, 1.0f);
    clip->frames[f].R_PB[index_of(Bone::kHead)] =
        Eigen::AngleAxisf(0.2f * t_s, Eigen::Vector3f::UnitY());
  }
  return clip;
}

ClipDancerOptions once() {
  ClipDancerOptions options;
  options.end = ClipEnd::kHold;
  return options;
}

Pose pose_at(ClipDancer& dancer, double t_s) {
  Pose pose;
  dancer.dance_at(Duration::seconds(t_s), pose);
  return pose;
}

TEST(ClipDancer, PlaysTheClipAsItIs) {
  const auto clip = walk();
  ClipDancer dancer(clip, once());
  EXPECT_DOUBLE_EQ(dancer.natural_hz(), kHz);
  EXPECT_EQ(dancer.skeleton(), clip->skeleton);
  EXPECT_LT((pose_at(dancer, 2.0).p_WH_m - Eigen::Vector3f(1.0f, 0.95f, 1.0f)).norm(), 1e-4f);
  EXPECT_LT(
      (pose_at(dancer, 2.0 + 0.5 / kHz).p_WH_m - Eigen::Vector3f(1.0041667f, 0.95f, 1.0f)).norm(),
      1e-4f);
}

TEST(ClipDancer, HoldsItsLastPoseAndIsOver) {
  ClipDancer dancer(walk(), once());
  EXPECT_FALSE(dancer.is_over(Duration::seconds(5.99)));
  EXPECT_TRUE(dancer.is_over(Duration::seconds(6.01)));
  EXPECT_LT((pose_at(dancer, 100.0).p_WH_m - Eigen::Vector3f(3.0f, 0.95f, 1.0f)).norm(), 1e-4f);
}

TEST(ClipDancer, PlaysAtAnotherSpeed) {
  ClipDancerOptions options = once();
  options.speed = 2.0;
  ClipDancer dancer(walk(), options);
  EXPECT_NEAR(pose_at(dancer, 1.0).p_WH_m.x(), 1.0f, 1e-4f);
  EXPECT_TRUE(dancer.is_over(Duration::seconds(3.01)));
}

TEST(ClipDancer, NeverEndsInALoop) {
  ClipDancer dancer(walk(), {});
  EXPECT_FALSE(dancer.is_over(Duration::s(1'000'000)));
}

// Nobody jumps where the clip begins again: hips and bones move on as fast as people do.
TEST(ClipDancer, LoopsWithoutAJump) {
  ClipDancer dancer(walk(), {});
  Pose before = pose_at(dancer, 0.0);
  float fastest_m_s = 0.0f;
  float fastest_rad_s = 0.0f;
  for (int i = 1; i < 60 * 30; ++i) {
    const Pose now = pose_at(dancer, i / kHz);
    fastest_m_s =
        std::max(fastest_m_s, (now.p_WH_m - before.p_WH_m).norm() * static_cast<float>(kHz));
    fastest_rad_s =
        std::max(fastest_rad_s, largest_angle_rad(now, before) * static_cast<float>(kHz));
    before = now;
  }
  // 3 m back within 2 s, at most 1.5 times the mean speed, against the walk of 0.5 m/s.
  EXPECT_LT(fastest_m_s, 2.5f);
  // 1.2 rad within 0.3 s, at most 1.5 times the mean.
  EXPECT_LT(fastest_rad_s, 6.5f);
  EXPECT_GT(fastest_m_s, 1.0f) << "the way back is walked";
}

TEST(ClipDancer, BeginsEachRoundWhereTheClipBegins) {
  ClipDancer dancer(walk(), {});
  const double round_s = dancer.round().as_seconds();
  EXPECT_NEAR(round_s, 5.7, 1e-6);
  // When the crossing is over the clip itself is shown.
  EXPECT_LT((pose_at(dancer, round_s + 1.0).p_WH_m - pose_at(dancer, 1.0).p_WH_m).norm(), 1e-4f);
  EXPECT_LT(largest_angle_rad(pose_at(dancer, 3 * round_s + 1.0), pose_at(dancer, 1.0)), 1e-3f);
  EXPECT_LT((pose_at(dancer, round_s).p_WH_m - pose_at(dancer, 0.0).p_WH_m).norm(), 1e-3f);
}

TEST(ClipDancer, KeepsCouplesInStep) {
  ClipDancer lead(walk(), {});
  auto other = std::make_shared<MotionClip>(*walk());
  for (Pose& pose : other->frames) pose.p_WH_m.x() *= -3.0f;
  ClipDancer follow(other, {});
  EXPECT_EQ(lead.round(), follow.round());
}

TEST(ClipDancer, StandsWhereItIsPut) {
  ClipDancerOptions options = once();
  options.placement = {2.0, -1.0, 90.0};
  ClipDancer dancer(walk(), options);
  const Pose pose = pose_at(dancer, 2.0);
  // (1, 1) on the floor turned by 90° about +Y is (1, −1).
  EXPECT_LT((pose.p_WH_m - Eigen::Vector3f(3.0f, 0.95f, -2.0f)).norm(), 1e-4f);
  EXPECT_LT((pose.R_PB[0] * Eigen::Vector3f::UnitZ() - Eigen::Vector3f::UnitX()).norm(), 1e-4f);
}

TEST(ClipDancer, LeavesTheCallersFieldsAlone) {
  ClipDancer dancer(walk(), {});
  Pose pose;
  pose.sequence = 7;
  pose.clock_id = 9;
  pose.capture_time = MonoTime::from_ns(5);
  for (const double t_s : {1.0, 5.8}) {
    dancer.dance_at(Duration::seconds(t_s), pose);
    EXPECT_EQ(pose.sequence, 7u);
    EXPECT_EQ(pose.clock_id, 9u);
    EXPECT_EQ(pose.capture_time, MonoTime::from_ns(5));
  }
}

TEST(ClipDancer, PlaysClipsOfOneAndTwoFrames) {
  for (const std::size_t frames : {1u, 2u}) {
    ClipDancer dancer(walk(frames), {});
    for (int i = 0; i < 100; ++i) EXPECT_TRUE(is_valid(pose_at(dancer, i * 0.013)));
  }
}

TEST(ClipDancer, PlaysTheFingersBesideTheBody) {
  auto clip = std::make_shared<MotionClip>(*walk(61));
  clip->hands.resize(61);
  for (std::size_t f = 0; f < 61; ++f) {
    clip->hands[f].presence = 8;
    clip->hands[f].R_PB[3] =
        Eigen::AngleAxisf(static_cast<float>(f) / 60.0f, Eigen::Vector3f::UnitZ());
  }
  ClipDancer dancer(clip, once());
  Hands hands;
  ASSERT_TRUE(dancer.hands_at(Duration::seconds(0.5 + 0.25 / kHz), hands));
  EXPECT_NEAR(hands.R_PB[3].angularDistance(Eigen::Quaternionf::Identity()), 30.25f / 60.0f, 1e-4f);
  EXPECT_EQ(hands.presence, 8u);
  ClipDancer bare(walk(), {});
  EXPECT_FALSE(bare.hands_at(Duration(), hands));
}

}  // namespace
}  // namespace dance
