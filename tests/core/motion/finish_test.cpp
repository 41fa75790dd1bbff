#include "core/motion/finish.h"

#include <gtest/gtest.h>

#include "tests/allocation_guard.h"
#include "tests/core/pose/random_pose.h"

namespace dance {
namespace {

MonoTime finish_frame(int i) { return MonoTime() + Duration::seconds(10.0 + i / 60.0); }

TEST(Finish, DoesNotTouchWhatIsDancedSo) {
  Finish finish;
  Random random(1);
  for (int i = 0; i < 60; ++i) {
    const Pose pose = random_pose(random, 0.2f);
    Pose out = pose;
    finish.apply(finish_frame(i), out, false);
    for (std::size_t b = 0; b < kBoneCount; ++b)
      EXPECT_EQ(out.R_PB[b].coeffs(), pose.R_PB[b].coeffs());
    EXPECT_EQ(out.p_WH_m, pose.p_WH_m);
  }
}

TEST(Finish, LimitsTheJointsOfAPrediction) {
  Finish finish;
  Pose pose;
  pose.R_PB[index_of(Bone::kLeftLowerLeg)] =
      Eigen::Quaternionf(Eigen::AngleAxisf(-1.5f, Eigen::Vector3f::UnitX()));
  Pose out = pose;
  finish.apply(finish_frame(0), out, true);
  EXPECT_LT(out.R_PB[index_of(Bone::kLeftLowerLeg)].angularDistance(Eigen::Quaternionf::Identity()),
            0.3f);
  finish.apply(finish_frame(1), pose, false);
  EXPECT_GT(
      pose.R_PB[index_of(Bone::kLeftLowerLeg)].angularDistance(Eigen::Quaternionf::Identity()),
      1.4f);
}

TEST(Finish, ThrowsNoLimbOfAPredictionAndCatchesUp) {
  constexpr std::size_t kFoot = index_of(Bone::kLeftFoot);
  Finish finish;
  Pose kicked;
  kicked.R_PB[kFoot] = Eigen::Quaternionf(Eigen::AngleAxisf(1.2f, Eigen::Vector3f::UnitX()));
  Pose before, out;
  finish.apply(MonoTime() + Duration::ms(100), before, true);
  for (int i = 1; i <= 8; ++i) {
    out = kicked;
    // The prediction is over before the foot is there.
    finish.apply(MonoTime() + Duration::ms(100 + 16 * i), out, i < 3);
    EXPECT_LT(out.R_PB[kFoot].angularDistance(before.R_PB[kFoot]),
              1.001f * TurnLimit::kFastest_rad_s * 0.016f);
    before = out;
  }
  EXPECT_EQ(out.R_PB[kFoot].coeffs(), kicked.R_PB[kFoot].coeffs());
  // What is danced so is shown so, however fast.
  out = Pose();
  finish.apply(MonoTime() + Duration::ms(300), out, false);
  EXPECT_EQ(out.R_PB[kFoot].coeffs(), Pose().R_PB[kFoot].coeffs());
}

TEST(Finish, HoldsAFootWhereItWasSeenToStand) {
  // A dancer who stands, and a prediction of them that slides at walking pace.
  const auto holds = [](bool is_seen) {
    Finish finish;
    Pose standing;
    standing.p_WH_m.y() = 1.0f;
    finish.apply(finish_frame(0), standing, true);
    for (int i = 1; i <= 6; ++i) {
      standing.capture_time = finish_frame(i);
      if (is_seen) finish.observe(standing, finish_frame(i));
    }
    for (int i = 7; i <= 12; ++i) {
      Pose predicted = standing;
      predicted.p_WH_m.x() = 0.5f * static_cast<float>(i - 7) / 60.0f;
      finish.apply(finish_frame(i), predicted, true);
    }
    return finish.feet().is_locked(0);
  };
  EXPECT_TRUE(holds(true));
  EXPECT_FALSE(holds(false));
}

TEST(Finish, ACorrectionByNothingLimitsNothing) {
  constexpr std::size_t kFoot = index_of(Bone::kLeftFoot);
  Finish finish;
  for (int i = 0; i < 8; ++i) {
    Pose pose;
    pose.R_PB[kFoot] =
        Eigen::Quaternionf(Eigen::AngleAxisf(i % 2 ? 0.6f : 0.0f, Eigen::Vector3f::UnitX()));
    finish.correct(finish_frame(i), pose, pose);
    Pose out = pose;
    finish.apply(finish_frame(i), out, false);
    EXPECT_EQ(out.R_PB[kFoot].coeffs(), pose.R_PB[kFoot].coeffs()) << i;
  }
}

TEST(Finish, CatchesUpAlsoWhereAMomentIsSampledTwice) {
  constexpr std::size_t kFoot = index_of(Bone::kLeftFoot);
  Finish finish;
  Pose kicked;
  kicked.R_PB[kFoot] = Eigen::Quaternionf(Eigen::AngleAxisf(1.2f, Eigen::Vector3f::UnitX()));
  Pose before, out;
  finish.apply(finish_frame(0), before, true);
  for (int i = 1; i <= 6; ++i) {
    out = kicked;
    finish.apply(finish_frame(i), out, i < 2);
    EXPECT_LT(out.R_PB[kFoot].angularDistance(before.R_PB[kFoot]),
              1.001f * TurnLimit::kFastest_rad_s / 60.0f);
    Pose again = kicked;
    finish.apply(finish_frame(i), again, i < 2);
    EXPECT_EQ(again.R_PB[kFoot].coeffs(), out.R_PB[kFoot].coeffs()) << i;
    before = out;
  }
  EXPECT_EQ(out.R_PB[kFoot].coeffs(), kicked.R_PB[kFoot].coeffs());
}

TEST(Finish, ComesBackToTheDanceAfterACorrection) {
  Finish finish(Duration::ms(60));
  Pose was, is;
  was.p_WH_m.x() = 0.2f;
  was.R_PB[3] = Eigen::Quaternionf(Eigen::AngleAxisf(0.5f, Eigen::Vector3f::UnitY()));
  finish.apply(finish_frame(0), was, false);
  finish.correct(finish_frame(1), was, is);
  Pose out = is;
  finish.apply(finish_frame(1), out, false);
  EXPECT_NEAR(out.p_WH_m.x(), 0.2f, 1e-4f);
  EXPECT_LT(out.R_PB[3].angularDistance(was.R_PB[3]), 2e-3f);
  for (int i = 2; i < 240; ++i) {
    out = is;
    finish.apply(finish_frame(i), out, false);
    for (const auto& q : out.R_PB) EXPECT_NEAR(q.norm(), 1.0f, 1e-5f);
  }
  for (std::size_t b = 0; b < kBoneCount; ++b)
    EXPECT_EQ(out.R_PB[b].coeffs(), is.R_PB[b].coeffs()) << b;
}

TEST(Finish, AllocatesNothingAndStaysABody) {
  Finish finish;
  Random random(2);
  const AllocationGuard guard;
  for (int i = 0; i < 500; ++i) {
    const Pose was = random_pose(random, 1.0f);
    Pose out = random_pose(random, 1.0f);
    if (i % 4 == 0) finish.correct(finish_frame(i), was, out);
    finish.apply(finish_frame(i), out, i % 3 != 0);
    ASSERT_TRUE(is_valid(out));
  }
  EXPECT_EQ(guard.allocations(), 0u);
}

}  // namespace
}  // namespace dance
