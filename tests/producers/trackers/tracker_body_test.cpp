#include "producers/trackers/tracker_body.h"

#include <gtest/gtest.h>

#include <limits>

#include "tests/allocation_guard.h"
#include "tests/producers/trackers/worn_points.h"

namespace dance {
namespace {

using Eigen::Vector3f;

class EachGuide : public testing::TestWithParam<TrackerGuide> {
 protected:
  TrackerBody solver_{{.guide = GetParam()}};
};
INSTANTIATE_TEST_SUITE_P(, EachGuide,
                         testing::Values(TrackerGuide::kGeometric, TrackerGuide::kLearned));

BodyFrames frames_of(const Skeleton& skeleton, const Pose& pose) {
  BodyFrames frames;
  forward_kinematics(skeleton, pose, frames);
  return frames;
}

TEST_P(EachGuide, HeadAndHandsAreWhereTheyAreMeasured) {
  SalsaDancer dancer = some_dancer();
  const WornPoints worn(dancer.skeleton(), kThreePoints);
  const double began = stand_in_t_pose(solver_, worn);
  Pose pose, solved;
  int far_hands = 0, frames = 0;
  for (double t = 0.0; t < 8.0; t += 1.0 / 90.0, ++frames) {
    dancer.dance_at(Duration::seconds(t), pose);
    const TrackerFrame frame = worn.see(pose, at_seconds(began + t));
    ASSERT_TRUE(solver_.solve(frame, solved));
    BonePlaces bones;
    solver_.calibration().place_bones(frame, bones);
    const BodyFrames body = frames_of(solver_.skeleton(), solved);
    EXPECT_LT((body.position(Bone::kHead) - bones.of(TrackedPoint::kHead).p_W_m).norm(), 1e-4f);
    EXPECT_LT(body.R_WB[index_of(Bone::kHead)].angularDistance(bones.of(TrackedPoint::kHead).R_W),
              2e-3f);
    for (const TrackedPoint hand : {TrackedPoint::kLeftHand, TrackedPoint::kRightHand}) {
      const Vector3f shown = body.p_WB_m[index_of(kPointBones[index_of(hand)])];
      if ((shown - bones.of(hand).p_W_m).norm() > 1e-3f) ++far_hands;
    }
  }
  // Where an arm is too short for what was measured.
  EXPECT_LT(far_hands, frames / 50);
}

TEST_P(EachGuide, AnyPointsWithAHeadGiveAWholeBody) {
  SalsaDancer dancer = some_dancer();
  WornPoints worn(dancer.skeleton(), (1u << kTrackedPointCount) - 1);
  double time = stand_in_t_pose(solver_, worn);
  Pose pose, solved;
  for (std::uint32_t points = 1; points < 1u << kTrackedPointCount; points += 2) {
    worn.points = points;
    for (int i = 0; i < 2; ++i, time += 1.0 / 90.0) {
      dancer.dance_at(Duration::seconds(time), pose);
      ASSERT_TRUE(solver_.solve(worn.see(pose, at_seconds(time)), solved)) << points;
      ASSERT_TRUE(is_valid(solved)) << points;
      EXPECT_LT((solved.p_WH_m - pose.p_WH_m).norm(), 0.7f) << points;
    }
  }
}

TEST_P(EachGuide, NothingGoesBelowTheFloor) {
  SalsaDancer dancer = some_dancer();
  for (const std::uint32_t points : {kThreePoints, kFourPoints, kSixPoints}) {
    solver_.reset();
    const WornPoints worn(dancer.skeleton(), points);
    const double began = stand_in_t_pose(solver_, worn);
    Pose pose, solved;
    for (double t = 0.0; t < 6.0; t += 1.0 / 90.0) {
      dancer.dance_at(Duration::seconds(t), pose);
      // Down to a squat and up again.
      pose.p_WH_m.y() -= 0.25f * static_cast<float>(1.0 - std::cos(t));
      solver_.solve(worn.see(pose, at_seconds(began + t)), solved);
      const BodyFrames body = frames_of(solver_.skeleton(), solved);
      for (const Bone ball : {Bone::kLeftToes, Bone::kRightToes})
        EXPECT_GT(body.position(ball).y(), -0.005f) << points << " at " << t;
      for (const Tip tip : {Tip::kLeftToes, Tip::kRightToes})
        EXPECT_GT(body.tip(tip).y(), -0.015f) << points << " at " << t;
    }
  }
}

Pose swaying(const Skeleton& body, double t) {
  Pose pose = standing(body);
  const auto sway = static_cast<float>(0.03 * std::sin(2.0 * t));
  pose.p_WH_m.x() += sway;
  return pose;
}

TEST_P(EachGuide, FeetStandWhileTheBodySways) {
  const WornPoints worn(average_skeleton(), kThreePoints);
  const double began = stand_in_t_pose(solver_, worn);
  Pose solved;
  BodyFrames before;
  float way = 0.0f;
  for (double t = 0.0; t < 6.0; t += 1.0 / 90.0) {
    solver_.solve(worn.see(swaying(worn.body, t), at_seconds(began + t)), solved);
    const BodyFrames body = frames_of(solver_.skeleton(), solved);
    if (t > 1.0) way += (body.position(Bone::kLeftToes) - before.position(Bone::kLeftToes)).norm();
    before = body;
  }
  EXPECT_LT(way, 0.05f) << "m in five seconds";
}

TEST_P(EachGuide, MeasuredFeetOfSomebodyWhoStandsAboutStayWhereTheyAre) {
  const WornPoints worn(average_skeleton(), kSixPoints);
  const double began = stand_in_t_pose(solver_, worn);
  Pose solved;
  const BodyFrames truth = frames_of(worn.body, standing(worn.body));
  for (double t = 0.0; t < 20.0; t += 1.0 / 60.0)
    solver_.solve(worn.see(swaying(worn.body, 0.3 * t), at_seconds(began + t)), solved);
  const BodyFrames body = frames_of(solver_.skeleton(), solved);
  for (const Bone foot : {Bone::kLeftFoot, Bone::kRightFoot})
    EXPECT_LT(std::abs(body.position(foot).z() - truth.position(foot).z()), 0.02f);
}

TEST_P(EachGuide, FeetFollowADancerWhoWalksOn) {
  const WornPoints worn(average_skeleton(), kThreePoints);
  const double began = stand_in_t_pose(solver_, worn);
  Pose solved;
  std::array<float, 2> highest{};
  BodyFrames body;
  for (double t = 0.0; t < 5.0; t += 1.0 / 90.0) {
    Pose pose = standing(worn.body);
    pose.p_WH_m.z() += static_cast<float>(0.5 * t);
    pose.p_WH_m.y() -= 0.03f;
    solver_.solve(worn.see(pose, at_seconds(began + t)), solved);
    body = frames_of(solver_.skeleton(), solved);
    highest[0] = std::max(highest[0], body.position(Bone::kLeftFoot).y());
    highest[1] = std::max(highest[1], body.position(Bone::kRightFoot).y());
  }
  for (const Bone foot : {Bone::kLeftFoot, Bone::kRightFoot})
    EXPECT_LT(std::abs(body.position(foot).z() - solved.p_WH_m.z()), 0.6f);
  if (GetParam() != TrackerGuide::kGeometric) return;
  for (const float height : highest) EXPECT_GT(height, 0.1f) << "they are lifted";
}

TEST_P(EachGuide, APointThatIsLostFadesAndComesBackWithoutAJump) {
  SalsaDancer dancer = some_dancer();
  for (const TrackedPoint lost :
       {TrackedPoint::kLeftHand, TrackedPoint::kHips, TrackedPoint::kLeftFoot}) {
    solver_.reset();
    WornPoints worn(dancer.skeleton(), kSixPoints);
    const double began = stand_in_t_pose(solver_, worn);
    Pose pose, solved;
    BodyFrames before;
    for (double t = 0.0; t < 6.0; t += 1.0 / 90.0) {
      dancer.dance_at(Duration::seconds(t), pose);
      TrackerFrame frame = worn.see(pose, at_seconds(began + t));
      if (t > 3.0 && t < 4.0) frame.remove(lost);
      solver_.solve(frame, solved);
      const BodyFrames body = frames_of(solver_.skeleton(), solved);
      if (t > 2.5) {
        EXPECT_LT(furthest_joint_m(body, before), 0.09f)
            << kTrackedPointNames[index_of(lost)] << " at " << t;
      }
      before = body;
    }
  }
}

TEST(TrackerBody, RefusesWhatCannotBe) {
  TrackerBody solver({.guide = TrackerGuide::kGeometric});
  const WornPoints worn(average_skeleton());
  const double began = stand_in_t_pose(solver, worn);
  const TrackerFrame good = worn.see(standing(worn.body), at_seconds(began));
  Pose pose;
  pose.p_WH_m.x() = 77.0f;
  const auto refused = [&](auto change) {
    TrackerFrame bad = good;
    change(bad);
    const float was = pose.p_WH_m.x();
    return !solver.solve(bad, pose) && pose.p_WH_m.x() == was;
  };
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_TRUE(refused([](auto& f) { f.p_WT_m[0].x() = kNan; }));
  EXPECT_TRUE(refused([](auto& f) { f.R_WT[1].w() = kNan; }));
  EXPECT_TRUE(refused([](auto& f) { f.R_WT[2].coeffs() *= 3.0f; }));
  EXPECT_TRUE(refused([](auto& f) { f.remove(TrackedPoint::kHead); }));
  EXPECT_TRUE(refused([&](auto& f) { f.time = good.time - Duration::ms(100); }));
  EXPECT_TRUE(solver.solve(good, pose));
  EXPECT_TRUE(refused([](auto&) {})) << "the same frame twice";
  TrackerFrame later = good;
  later.time = good.time + Duration::s(3600);
  EXPECT_TRUE(solver.solve(later, pose));
  later.time = good.time + Duration::ms(20);
  EXPECT_TRUE(solver.solve(later, pose)) << "one wrong stamp does not stop it";
}

TEST_P(EachGuide, AHandThatFlickersHoldsNothingUp) {
  SalsaDancer dancer = some_dancer();
  WornPoints worn(dancer.skeleton(), kThreePoints);
  const double began = stand_in_t_pose(solver_, worn);
  Pose pose, solved, steady;
  // A dancer who goes two metres aside, with a hand at the edge of what the cameras see.
  float most = 0.0f;
  for (int i = 0; i < 180; ++i) {
    worn.points = i % 2 == 0 ? kThreePoints : kThreePoints & ~0b010u;
    dancer.dance_at(Duration::seconds(0.0), pose);
    pose.p_WH_m.x() += 2.0f * static_cast<float>(i) / 180.0f;
    ASSERT_TRUE(solver_.solve(worn.see(pose, at_seconds(began + i / 90.0)), solved));
    if (i > 30) most = std::max(most, (solved.p_WH_m - pose.p_WH_m).norm());
  }
  EXPECT_LT(most, 0.25f);
}

TEST_P(EachGuide, NeverAllocates) {
  SalsaDancer dancer = some_dancer();
  const WornPoints worn(dancer.skeleton(), kSixPoints);
  std::vector<TrackerFrame> frames;
  Pose pose;
  for (double t = 0.0; t < 3.0; t += 1.0 / 90.0) {
    dancer.dance_at(Duration::seconds(t), pose);
    frames.push_back(worn.see(t < 1.2 ? standing(worn.body) : pose, at_seconds(t)));
  }
  const AllocationGuard guard;
  for (const TrackerFrame& frame : frames) solver_.solve(frame, pose);
  solver_.reset();
  EXPECT_EQ(guard.allocations(), 0u);
}

TEST_P(EachGuide, SaysAboutTheSameAtAnyRate) {
  SalsaDancer dancer = some_dancer();
  const WornPoints worn(dancer.skeleton(), kFourPoints);
  std::array<std::vector<BodyFrames>, 2> seconds;
  for (std::size_t way = 0; way < 2; ++way) {
    solver_.reset();
    const double hz = way == 0 ? 60.0 : 144.0;
    Pose pose, solved;
    for (int i = 0; i < static_cast<int>(8.0 * hz); ++i) {
      const double t = i / hz;
      dancer.dance_at(Duration::seconds(std::max(0.0, t - 1.2)), pose);
      solver_.solve(worn.see(t < 1.2 ? standing(worn.body) : pose, at_seconds(t)), solved);
      if (i % static_cast<int>(hz / 12.0) == 0 && t > 3.0)
        seconds[way].push_back(frames_of(solver_.skeleton(), solved));
    }
  }
  ASSERT_EQ(seconds[0].size(), seconds[1].size());
  double apart = 0.0;
  for (std::size_t i = 0; i < seconds[0].size(); ++i)
    for (std::size_t b = 0; b < kBoneCount; ++b)
      apart += static_cast<double>((seconds[0][i].p_WB_m[b] - seconds[1][i].p_WB_m[b]).norm());
  apart /= static_cast<double>(seconds[0].size() * kBoneCount);
  EXPECT_LT(apart, 0.02) << "m, mean over joints";
}

}  // namespace
}  // namespace dance
