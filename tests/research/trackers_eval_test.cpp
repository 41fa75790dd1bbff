// What judges and trains bodies from few points, and how good they are on recorded dances.
#include "research/trackers/trackers_eval.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "producers/salsa/salsa_dancer.h"
#include "research/trackers/tracker_net_fit.h"
#include "research/trackers/worn_devices.h"

namespace dance {
namespace {

PredictTake drawn_take(double seconds) {
  SalsaStyle style;
  SalsaDancer dancer{style};
  PredictTake take;
  take.name = "drawn";
  take.skeleton = dancer.skeleton();
  for (int i = 0; i < static_cast<int>(60.0 * seconds); ++i) {
    Pose pose;
    dancer.dance_at(Duration::seconds(i / 60.0), pose);
    normalize(pose);
    pose.capture_time = MonoTime() + Duration::seconds(1.0 + i / 60.0);
    take.poses.push_back(pose);
  }
  return take;
}

TEST(HumanTake, OnAnotherBodyTheBallsOfTheFeetKeepTheirPath) {
  const PredictTake take = drawn_take(4.0);
  Random random(3);
  const Skeleton body = human_skeleton(1.9f, 0.04f, random);
  const PredictTake put = on_body(take, body);
  ASSERT_EQ(put.poses.size(), take.poses.size());
  BodyFrames was, is;
  float grows = 0.0f;
  for (std::size_t i = 0; i < put.poses.size(); i += 10) {
    forward_kinematics(take.skeleton, take.poses[i], was);
    forward_kinematics(body, put.poses[i], is);
    EXPECT_LT(put.poses[i].R_PB[index_of(Bone::kChest)].angularDistance(
                  take.poses[i].R_PB[index_of(Bone::kChest)]),
              1e-3f);
    const float ratio = is.position(Bone::kLeftToes).x() / was.position(Bone::kLeftToes).x();
    if (std::abs(was.position(Bone::kLeftToes).x()) < 0.1f) continue;
    if (grows == 0.0f) grows = ratio;
    EXPECT_NEAR(ratio, grows, 0.05f * grows) << i;
  }
}

TEST(WornDevices, TrembleByAboutAMillimetre) {
  const Skeleton body = average_skeleton();
  WornDevices devices(body, point_set(3), 5);
  Pose pose;
  Eigen::Vector3f mean = Eigen::Vector3f::Zero();
  std::vector<Eigen::Vector3f> seen;
  for (int i = 0; i < 20000; ++i)
    seen.push_back(devices.see(pose, 90.0).position(TrackedPoint::kLeftHand));
  for (const auto& p : seen) mean += p / static_cast<float>(seen.size());
  double square = 0.0;
  for (const auto& p : seen) square += static_cast<double>((p - mean).squaredNorm());
  EXPECT_NEAR(std::sqrt(square / static_cast<double>(3 * seen.size())), 0.001, 0.0003);
}

TEST(TrackerFit, TheSameSeedGivesTheSameNetworkAndItLearns) {
  Random random(1);
  const std::vector<TrackerDance> dances = tracker_dances(drawn_take(4.0), 1, random);
  TrackerFit fit;
  fit.rounds = 2;
  const TrackerNet first = fit_tracker_net(dances, fit), again = fit_tracker_net(dances, fit);
  EXPECT_EQ(first.out, again.out);
  EXPECT_EQ(first.layers[0].in, again.layers[0].in);
  fit.seed = 2;
  EXPECT_NE(fit_tracker_net(dances, fit).out, first.out);
}

// The built-in model has seen these takes; docs/trackers.md has the table of one that had not.
TEST(TrackerTakes, TheNetworkIsBetterThanRulesForAnyPoints) {
  const std::string path = DANCE_SOURCE_DIR "/../shared/data/mocap/cmu_61_12_salsa.bvh.xz";
  if (!std::filesystem::exists(path))
    GTEST_SKIP() << path << " is missing: no real takes beside this tree";
  auto take = load_predict_take(path, 60.0);
  ASSERT_TRUE(take);
  take->poses.resize(900);
  TrackerEvalOptions options;
  options.model = built_in_tracker_model();
  for (const int points : {3, 4, 6, 10}) {
    const TrackerScore rules =
        judge_trackers(*take, {points, TrackerGuide::kGeometric, TrackerStart::kTPose}, options);
    const TrackerScore learned =
        judge_trackers(*take, {points, TrackerGuide::kLearned, TrackerStart::kTPose}, options);
    EXPECT_LT(learned.joints_m, rules.joints_m) << points;
    EXPECT_LT(learned.turns_deg, rules.turns_deg) << points;
  }
}

}  // namespace
}  // namespace dance
