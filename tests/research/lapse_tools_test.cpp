#include <gtest/gtest.h>

#include <cmath>

#include "research/lapse/lapse_eval.h"
#include "research/lapse/predict_stream.h"

namespace dance {
namespace {

// A dance that repeats every 1.6 s, for 14 s.
CodecTake repeating_take() {
  CodecTake take;
  take.name = "repeating";
  take.skeleton = average_skeleton();
  for (int i = 0; i < 840; ++i) {
    const double t_s = i / 60.0;
    const auto phase = static_cast<float>(2.0 * M_PI * t_s / 1.6);
    Pose pose;
    pose.R_PB[index_of(Bone::kLeftUpperArm)] =
        Eigen::Quaternionf(Eigen::AngleAxisf(0.7f * std::sin(phase), Eigen::Vector3f::UnitZ()));
    pose.R_PB[index_of(Bone::kRightUpperArm)] =
        Eigen::Quaternionf(Eigen::AngleAxisf(0.5f * std::cos(phase), Eigen::Vector3f::UnitY()));
    pose.sequence = static_cast<std::uint32_t>(i);
    pose.capture_time = MonoTime() + Duration::seconds(1.0 + t_s);
    take.poses.push_back(pose);
  }
  return take;
}

TEST(LapseEval, AFrozenPoseIsDeadAndADanceThatRepeatsGoesOn) {
  const std::vector<CodecTake> takes{repeating_take()};
  const LapseFigures frozen = evaluate_lapse(takes, newest_subject(), Duration::s(1));
  EXPECT_GT(frozen.trials, 3);
  EXPECT_EQ(frozen.activity, 0.0);
  EXPECT_GT(frozen.return_peak, 2.0) << "it jumps when it comes back";
  const LapseFigures ours = evaluate_lapse(takes, continuation_subject(), Duration::s(1));
  EXPECT_NEAR(ours.activity, 1.0, 0.1);
  EXPECT_LT(ours.error_m, 0.1 * frozen.error_m);
  EXPECT_LT(ours.return_peak, 1.2);
  EXPECT_LT(ours.return_error_m, 0.005);
}

TEST(LapseEval, ATakeThatIsTooShortAddsNothing) {
  std::vector<CodecTake> takes{repeating_take()};
  takes[0].poses.resize(300);
  EXPECT_EQ(evaluate_lapse(takes, newest_subject(), Duration::s(1)).trials, 0);
}

TEST(PredictStream, TheNewestPoseIsAsLateAsTheLineAndAStandstillWouldBeNoLag) {
  const std::vector<CodecTake> takes{repeating_take()};
  StreamOptions options;
  options.delay = Duration::ms(100);
  const StreamFigures raw = evaluate_stream(takes, newest_subject(), options);
  EXPECT_NEAR(raw.lag_s, 0.1, 0.004);
  EXPECT_NEAR(raw.jerk, 1.0, 0.05) << "a line without jitter is smooth";
  EXPECT_NEAR(raw.play_least, 1.0, 1e-3);
  options.delay = Duration();
  EXPECT_NEAR(evaluate_stream(takes, newest_subject(), options).lag_s, 0.0, 1e-3);
}

TEST(PredictStream, JitterShowsAsJerkAndDeadReckoningTakesLagBack) {
  const std::vector<CodecTake> takes{repeating_take()};
  StreamOptions options;
  options.jitter = Duration::ms(15);
  options.loss_percent = 1.0;
  const StreamFigures raw = evaluate_stream(takes, newest_subject(), options);
  const StreamFigures damped = evaluate_stream(takes, damped_velocity_subject(), options);
  EXPECT_GT(raw.jerk, 3.0);
  EXPECT_GT(raw.lag_s, 0.1);
  EXPECT_LT(damped.lag_s, 0.7 * raw.lag_s);
  EXPECT_LT(damped.error_m, raw.error_m);
}

TEST(StationsOf, ReadsChainsAsPeopleWriteThem) {
  EXPECT_EQ(words_of("predict lead=1,bridge"),
            (std::vector<std::string>{"predict lead=1", "bridge"}));
  EXPECT_TRUE(words_of("").empty());
}

}  // namespace
}  // namespace dance
