#include <gtest/gtest.h>

#include <limits>
#include <numbers>

#include "tests/producers/trackers/worn_points.h"

namespace dance {
namespace {

using Eigen::Vector3f;

TEST(TrackerMounts, HandsHoldGripPosesAsOpenXrSays) {
  // In T-pose, facing +Z, palms are down and thumbs ahead.
  const Place left = device_place(nominal_mount(TrackedPoint::kLeftHand, 1.72f), Place());
  const Place right = device_place(nominal_mount(TrackedPoint::kRightHand, 1.72f), Place());
  EXPECT_TRUE((left.R_W * Vector3f::UnitX()).isApprox(-Vector3f::UnitY())) << "out of the palm";
  EXPECT_TRUE((right.R_W * Vector3f::UnitX()).isApprox(Vector3f::UnitY())) << "out of the back";
  for (const Place& hand : {left, right})
    EXPECT_TRUE((hand.R_W * -Vector3f::UnitZ()).isApprox(Vector3f::UnitZ())) << "to the thumb";
  EXPECT_GT(left.p_W_m.x(), 0.05f);
  EXPECT_LT(right.p_W_m.x(), -0.05f);
}

// In T-pose the model of the body is the body itself, so that what is found is exact but for feet,
// which people do not put quite parallel.
TEST(TrackerCalibration, ATPoseFindsHeightAndMounts) {
  const Skeleton body = average_skeleton(1.83f);
  const WornPoints worn(body, kTenPoints);
  TrackerBody solver({.guide = TrackerGuide::kGeometric});
  stand_in_t_pose(solver, worn, 90.0, 0.7f);
  const CalibrationValues& found = solver.calibration().values();
  ASSERT_EQ(found.state, CalibrationState::kFromTPose);
  EXPECT_NEAR(found.height_m, 1.83f, 0.005f);
  EXPECT_NEAR(found.arm_ratio, 1.0f, 0.02f);
  for (std::size_t i = 0; i < 10; ++i) {
    const bool is_foot =
        i == index_of(TrackedPoint::kLeftFoot) || i == index_of(TrackedPoint::kRightFoot);
    ASSERT_TRUE(found.mounts[i].is_known) << kTrackedPointNames[i];
    EXPECT_LT((found.mounts[i].p_BT_m - worn.mounts[i].p_BT_m).norm(), is_foot ? 0.03f : 0.012f)
        << kTrackedPointNames[i];
    EXPECT_LT(found.mounts[i].R_BT.angularDistance(worn.mounts[i].R_BT), is_foot ? 0.12f : 0.05f)
        << kTrackedPointNames[i];
  }
}

TEST(TrackerCalibration, ATPoseFindsTheLengthOfTheArms) {
  Skeleton body = average_skeleton(1.7f);
  for (const Bone bone :
       {Bone::kLeftLowerArm, Bone::kLeftHand, Bone::kRightLowerArm, Bone::kRightHand})
    body.offset_m[index_of(bone)] *= 1.08f;
  TrackerBody solver({.guide = TrackerGuide::kGeometric});
  stand_in_t_pose(solver, WornPoints(body, kThreePoints));
  EXPECT_NEAR(solver.calibration().values().arm_ratio, 1.08f, 0.02f);
  EXPECT_NEAR(solver.skeleton().offset(Bone::kLeftHand).norm(), body.offset(Bone::kLeftHand).norm(),
              0.006f);
}

Pose with_arms_down(const Skeleton& body) {
  Pose pose = standing(body);
  const Eigen::AngleAxisf left(-1.3f, Vector3f::UnitZ()), right(1.3f, Vector3f::UnitZ());
  pose.R_PB[index_of(Bone::kLeftUpperArm)] = Eigen::Quaternionf(left);
  pose.R_PB[index_of(Bone::kRightUpperArm)] = Eigen::Quaternionf(right);
  return pose;
}

TEST(TrackerCalibration, ArmsThatHangAreNoTPose) {
  const WornPoints worn(average_skeleton(), kSixPoints);
  TrackerBody solver({.guide = TrackerGuide::kGeometric});
  Pose pose;
  solver.request_t_pose();
  for (double t = 0.0; t < 3.0; t += 0.01)
    solver.solve(worn.see(with_arms_down(worn.body), at_seconds(t)), pose);
  EXPECT_EQ(solver.calibration().state(), CalibrationState::kNeedsTPose);
  EXPECT_TRUE(solver.calibration().awaits_t_pose());
}

TEST(TrackerCalibration, SomebodyWhoSitsWithStretchedArmsIsNoTPose) {
  const WornPoints worn(average_skeleton(), kThreePoints);
  TrackerBody solver({.guide = TrackerGuide::kGeometric});
  Pose pose, seated = standing(worn.body);
  seated.p_WH_m.y() -= 0.4f;
  solver.request_t_pose();
  for (double t = 0.0; t < 3.0; t += 0.01) solver.solve(worn.see(seated, at_seconds(t)), pose);
  EXPECT_EQ(solver.calibration().state(), CalibrationState::kNeedsTPose);
}

TEST(TrackerCalibration, ATPoseThatWasAskedForWaitsForHandsThatWereSeen) {
  WornPoints worn(average_skeleton(), kThreePoints);
  TrackerBody solver({.guide = TrackerGuide::kGeometric});
  Pose pose;
  solver.request_t_pose();
  solver.solve(worn.see(with_arms_down(worn.body), at_seconds(0.0)), pose);
  worn.points = 0b1;  // out of the cameras' sight
  for (double t = 0.01; t < 3.0; t += 0.01)
    solver.solve(worn.see(with_arms_down(worn.body), at_seconds(t)), pose);
  EXPECT_EQ(solver.calibration().state(), CalibrationState::kNeedsTPose);
  EXPECT_TRUE(solver.calibration().awaits_t_pose());
  // It is not waited for for ever.
  for (double t = 3.0; t < 70.0; t += 0.05)
    solver.solve(worn.see(with_arms_down(worn.body), at_seconds(t)), pose);
  EXPECT_FALSE(solver.calibration().awaits_t_pose());
}

TEST(TrackerCalibration, AHeadsetOnATableIsNobody) {
  WornPoints worn(average_skeleton(), kSixPoints);
  TrackerBody solver({.guide = TrackerGuide::kGeometric});
  Pose pose, lies = standing(worn.body);
  lies.p_WH_m.y() -= 0.6f;
  for (double t = 0.0; t < 40.0; t += 0.05) solver.solve(worn.see(lies, at_seconds(t)), pose);
  EXPECT_EQ(solver.calibration().state(), CalibrationState::kNeedsTPose);
  EXPECT_FALSE(solver.calibration().values().mounts[index_of(TrackedPoint::kHips)].is_known);
}

TEST(TrackerCalibration, ATrackerThatFlickersDoesNotHoldUpTheTPose) {
  WornPoints worn(average_skeleton(), kSixPoints);
  TrackerBody solver({.guide = TrackerGuide::kGeometric});
  Pose pose;
  for (int i = 0; i < 120; ++i) {
    worn.points = i % 5 == 0 ? kSixPoints & ~(1u << index_of(TrackedPoint::kLeftFoot)) : kSixPoints;
    solver.solve(worn.see(standing(worn.body), at_seconds(i / 90.0)), pose);
  }
  EXPECT_EQ(solver.calibration().state(), CalibrationState::kFromTPose);
  EXPECT_TRUE(solver.calibration().values().mounts[index_of(TrackedPoint::kLeftFoot)].is_known);
}

TEST(TrackerCalibration, ASecondTPoseCountsOnlyWhereItIsAskedFor) {
  TrackerBody solver({.guide = TrackerGuide::kGeometric});
  stand_in_t_pose(solver, WornPoints(average_skeleton(1.6f), kThreePoints));
  const WornPoints taller(average_skeleton(1.8f), kThreePoints);
  Pose pose;
  for (double t = 2.0; t < 4.0; t += 0.01)
    solver.solve(taller.see(standing(taller.body), at_seconds(t)), pose);
  EXPECT_NEAR(solver.calibration().values().height_m, 1.6f, 0.01f);
  solver.request_t_pose();
  for (double t = 4.0; t < 6.0; t += 0.01)
    solver.solve(taller.see(standing(taller.body), at_seconds(t)), pose);
  EXPECT_NEAR(solver.calibration().values().height_m, 1.8f, 0.01f);
  EXPECT_FALSE(solver.calibration().awaits_t_pose());
}

TEST(TrackerCalibration, AskedForItTakesATPoseWithoutHands) {
  WornPoints worn(average_skeleton(1.75f), kSixPoints & ~0b110u);
  TrackerBody solver({.guide = TrackerGuide::kGeometric});
  stand_in_t_pose(solver, worn);
  EXPECT_EQ(solver.calibration().state(), CalibrationState::kNeedsTPose);
  solver.request_t_pose();
  Pose pose;
  for (double t = 2.0; t < 3.5; t += 0.01)
    solver.solve(worn.see(standing(worn.body), at_seconds(t)), pose);
  EXPECT_EQ(solver.calibration().state(), CalibrationState::kFromTPose);
}

TEST(TrackerCalibration, WalkingAboutTellsHeightAndHowTrackersAreTurned) {
  SalsaDancer dancer = some_dancer();
  const WornPoints worn(dancer.skeleton(), kSixPoints);
  TrackerBody solver({.guide = TrackerGuide::kGeometric});
  Pose pose, solved;
  for (double t = 0.0; t < 30.0; t += 1.0 / 60.0) {
    dancer.dance_at(Duration::seconds(t), pose);
    solver.solve(worn.see(pose, at_seconds(t)), solved);
  }
  const CalibrationValues& found = solver.calibration().values();
  ASSERT_EQ(found.state, CalibrationState::kFromWalking);
  const float height = standing_height_m(worn.body);
  EXPECT_NEAR(found.height_m, height, 0.05f * height);
  for (const TrackedPoint point :
       {TrackedPoint::kHips, TrackedPoint::kLeftFoot, TrackedPoint::kRightFoot}) {
    const Mount& mount = found.mounts[index_of(point)];
    ASSERT_TRUE(mount.is_known);
    EXPECT_LT(mount.R_BT.angularDistance(worn.mounts[index_of(point)].R_BT), 0.5f)
        << kTrackedPointNames[index_of(point)];
  }
}

TEST(TrackerCalibration, WhatWasFoundCanBeKeptAndRestored) {
  const WornPoints worn(average_skeleton(1.66f), kTenPoints);
  TrackerBody first({.guide = TrackerGuide::kGeometric});
  stand_in_t_pose(first, worn);
  TrackerBody second({.guide = TrackerGuide::kGeometric});
  ASSERT_TRUE(second.restore(first.calibration().values()));
  EXPECT_EQ(second.calibration().state(), CalibrationState::kFromTPose);
  EXPECT_EQ(second.skeleton().offset_m, first.skeleton().offset_m);
  Pose pose;
  ASSERT_TRUE(second.solve(worn.see(standing(worn.body), at_seconds(0.0)), pose));
  EXPECT_NEAR(pose.p_WH_m.y(), worn.body.hips_height_m(), 0.01f);
}

TEST(TrackerCalibration, RefusesValuesThatCannotBeTrue) {
  TrackerCalibration calibration;
  const CalibrationValues good = calibration.values();
  ASSERT_TRUE(calibration.restore(good));
  const auto refused = [&](auto change) {
    CalibrationValues bad = good;
    change(bad);
    return !calibration.restore(bad);
  };
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_TRUE(refused([](auto& v) { v.height_m = kNan; }));
  EXPECT_TRUE(refused([](auto& v) { v.height_m = 3.0f; }));
  EXPECT_TRUE(refused([](auto& v) { v.arm_ratio = 2.0f; }));
  EXPECT_TRUE(refused([](auto& v) { v.mounts[0].is_known = false; }));
  EXPECT_TRUE(refused([](auto& v) { v.mounts[1].p_BT_m.x() = kNan; }));
  EXPECT_TRUE(refused([](auto& v) { v.mounts[2].R_BT.w() = 5.0f; }));
  EXPECT_TRUE(refused([](auto& v) { v.state = static_cast<CalibrationState>(7); }));
}

}  // namespace
}  // namespace dance
