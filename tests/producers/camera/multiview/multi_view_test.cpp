#include "producers/camera/multiview/multi_view.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/allocation_guard.h"
#include "tests/producers/camera/multiview/seen_twice.h"

namespace dance {
namespace {

constexpr double kDegrees = 57.29577951308232;

MultiView views_of(const SeenTwice& seen) {
  MultiView views(seen.first.camera.pinhole);
  views.add_camera(seen.other.eye.camera.pinhole);
  return views;
}

DancerSize told(const SeenTwice& seen) { return {seen.first.height_m, 0.0}; }

// Runs all pictures; true where the second camera is placed at the end.
bool place(const SeenTwice& seen, MultiView& views) {
  std::size_t next = 0;
  for (const SceneFrame& frame : seen.first.frames) {
    see_others(seen, frame.landmarks.capture_time, next, views);
    views.see_first(frame.landmarks, told(seen));
  }
  return views.pair(0).is_settled();
}

double turn_error_deg(const SeenTwice& seen, const RelativePose& pose) {
  const Eigen::Matrix3d R_BA = seen.other.R_WC.transpose() * seen.first.R_WC;
  return kDegrees * Eigen::AngleAxisd(pose.R_BA * R_BA.transpose()).angle();
}

double place_error_m(const SeenTwice& seen, const PairPlacement& placement) {
  const Eigen::Vector3d p_AB_m =
      seen.first.R_WC.transpose() * (seen.other.p_WC_m - seen.first.p_WC_m);
  const RelativePose& pose = placement.pose;
  return (-(pose.R_BA.transpose() * pose.p_BA) * placement.baseline_m - p_AB_m).norm();
}

TEST(MultiView, PlacesACameraExactlyWhereNetworksMakeNoErrors) {
  const SeenTwice seen = seen_twice(10.0, no_errors());
  MultiView views = views_of(seen);
  ASSERT_TRUE(place(seen, views));
  const PairPlacement& placement = *views.pair(0).placement();
  EXPECT_LT(turn_error_deg(seen, placement.pose), 0.2);
  EXPECT_LT(place_error_m(seen, placement), 0.05);
  EXPECT_NEAR(1e3 * placement.pose.later_s, 20.0, 1.0);
  EXPECT_NEAR(placement.angle_rad, 1.0, 0.05);
}

TEST(MultiView, PlacesACameraBeforeNetworksWithErrors) {
  const SeenTwice seen = seen_twice(14.0, SceneErrors());
  MultiView views = views_of(seen);
  ASSERT_TRUE(place(seen, views));
  const PairPlacement& placement = *views.pair(0).placement();
  EXPECT_LT(turn_error_deg(seen, placement.pose), 2.5);
  EXPECT_LT(place_error_m(seen, placement), 0.2);
  EXPECT_NEAR(1e3 * placement.pose.later_s, 20.0, 4.0);
  EXPECT_EQ(views.pair(0).moves(), 0);
}

TEST(MultiView, TellsTheLengthsOfTheBodyOnceOfTheToldHeight) {
  const SeenTwice seen = seen_twice(14.0, no_errors());
  MultiView views = views_of(seen);
  std::size_t next = 0;
  int told_times = 0;
  BodyLengths lengths{};
  for (const SceneFrame& frame : seen.first.frames) {
    see_others(seen, frame.landmarks.capture_time, next, views);
    views.see_first(frame.landmarks, told(seen));
    if (const auto taken = views.take_lengths()) {
      lengths = *taken;
      ++told_times;
    }
  }
  EXPECT_EQ(told_times, 1);
  const BodyFrames rest = [&] {
    BodyFrames frames;
    forward_kinematics(salsa_skeleton(), Pose(), frames);
    return frames;
  }();
  const double thigh_m = static_cast<double>(
      (rest.position(Bone::kLeftLowerLeg) - rest.position(Bone::kLeftUpperLeg)).norm());
  EXPECT_NEAR(lengths[static_cast<std::size_t>(Length::kThigh)] / thigh_m, 1.0, 0.02);
}

TEST(MultiView, ADancerWhoStandsStillPlacesNoCamera) {
  SeenTwice seen = seen_twice(10.0, no_errors());
  for (SceneFrame& frame : seen.first.frames) {
    const MonoTime time = frame.landmarks.capture_time;
    frame = seen.first.frames.front();
    frame.landmarks.capture_time = time;
  }
  MultiView views = views_of(seen);
  EXPECT_FALSE(place(seen, views));
  EXPECT_LT(views.pair(0).moments(), 2);
}

TEST(MultiView, ACameraThatIsMovedIsNoticedAndPlacedAgain) {
  const SeenTwice seen = seen_twice(26.0, SceneErrors());
  const SeenTwice moved = seen_twice(26.0, SceneErrors(), 1.2, 0.22);
  MultiView views = views_of(seen);
  std::size_t next = 0;
  for (std::size_t f = 0; f < seen.first.frames.size(); ++f) {
    const BodyLandmarks& body = seen.first.frames[f].landmarks;
    const bool is_moved = f > 14 * 30;
    see_others(is_moved ? moved : seen, body.capture_time, next, views);
    views.see_first(body, told(seen));
    if (f == 14 * 30) {
      EXPECT_TRUE(views.pair(0).is_settled());
    }
  }
  EXPECT_EQ(views.pair(0).moves(), 1);
  ASSERT_TRUE(views.pair(0).is_settled());
  EXPECT_LT(turn_error_deg(moved, views.pair(0).placement()->pose), 2.5);
}

TEST(MultiView, AViewThatIsTooOldIsLeftOut) {
  const SeenTwice seen = seen_twice(12.0, no_errors());
  MultiView views = views_of(seen);
  ASSERT_TRUE(place(seen, views));
  BodyLandmarks body = seen.first.frames.back().landmarks;
  body.capture_time += Duration::ms(40);
  EXPECT_EQ(views.see_first(body, told(seen)).size(), 1u);
  body.capture_time += Duration::ms(200);
  EXPECT_EQ(views.see_first(body, told(seen)).size(), 1u) << "as late as a placement may be";
  body.capture_time += Duration::ms(200);
  EXPECT_EQ(views.see_first(body, told(seen)).size(), 0u);
}

TEST(MultiView, AllocatesNothingAndIsFastWithGarbage) {
  SeenTwice seen = seen_twice(8.0, SceneErrors());
  for (std::size_t i = 0; i < seen.other.moments.size(); i += 5) {
    BodyLandmarks& body = seen.other.moments[i].landmarks;
    body.image_px[11].x() = std::numeric_limits<float>::quiet_NaN();
    body.image_px[25].y() = 1e30f;
    body.world_m[23].z() = std::numeric_limits<float>::infinity();
    if (i % 3 == 0) body.capture_time = MonoTime();
  }
  MultiView views = views_of(seen);
  std::size_t next = 0;
  const AllocationGuard guard;
  for (const SceneFrame& frame : seen.first.frames) {
    see_others(seen, frame.landmarks.capture_time, next, views);
    for (const OtherView& view : views.see_first(frame.landmarks, told(seen))) {
      EXPECT_TRUE(view.R_VC.allFinite() && view.p_VC_m.allFinite());
    }
  }
  EXPECT_EQ(guard.allocations(), 0u);
}

TEST(ViewHistory, InterpolatesAndRefusesGaps) {
  ViewHistory history;
  ViewPoints points;
  points.ray.fill(Eigen::Vector2f::Zero());
  points.weight.fill(1.0f);
  const auto at = [](int ms) { return MonoTime() + Duration::ms(1000 + ms); };
  for (const int ms : {0, 30, 60, 300}) {
    points.time = at(ms);
    points.ray[0].x() = 0.001f * static_cast<float>(ms);
    EXPECT_TRUE(history.add(points));
  }
  EXPECT_FALSE(history.add(points));
  ViewMoment moment;
  ASSERT_TRUE(history.at(at(40), moment));
  EXPECT_NEAR(moment.ray[0].x(), 0.04, 1e-6);
  EXPECT_NEAR(moment.rate[0].x(), 1.0, 1e-5);
  EXPECT_FALSE(history.at(at(200), moment));
  EXPECT_FALSE(history.at(at(-10), moment));
  EXPECT_FALSE(history.at(at(310), moment));
}

TEST(RelativePose, RaysOfAPointMeetThere) {
  RelativePose pose;
  pose.R_BA =
      Eigen::AngleAxisd(0.7, Eigen::Vector3d(0.1, 1.0, 0.0).normalized()).toRotationMatrix();
  pose.p_BA = Eigen::Vector3d(0.8, 0.1, 0.5).normalized();
  const Eigen::Vector3d p_A(0.3, -0.2, 1.4);
  const Eigen::Vector3d p_B = pose.R_BA * p_A + pose.p_BA;
  MetPoint met;
  ASSERT_TRUE(meet(pose, p_A.hnormalized(), p_B.hnormalized(), 0.002, 0.002, met));
  EXPECT_LT((met.p_A - p_A).norm(), 1e-9);
  EXPECT_GT(met.variance, 0.0);
  EXPECT_LT(met.variance, 1e-3);
  // The same rays, lengthened backwards, meet behind the first camera.
  const Eigen::Vector3d behind_A(0.3, -0.2, -1.4);
  const Eigen::Vector3d behind_B = pose.R_BA * behind_A + pose.p_BA;
  EXPECT_FALSE(meet(pose, behind_A.hnormalized(), behind_B.hnormalized(), 0.002, 0.002, met));
}

}  // namespace
}  // namespace dance
