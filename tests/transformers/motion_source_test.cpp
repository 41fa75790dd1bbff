#include "transformers/motion_source.h"

#include <gtest/gtest.h>

#include "tests/transformers/flows.h"

namespace dance {
namespace {

using Kind = MotionSource::Kind;

// Hips at 1 m/s along x.
Pose pose_at(int ms) {
  Pose pose;
  pose.capture_time = at_ms(ms);
  pose.clock_id = 1;
  pose.p_WH_m.x() = 1e-3f * static_cast<float>(ms);
  pose.music_beats = 2e-3 * static_cast<double>(ms);
  pose.stamp(Hop::kStageTaken, at_ms(ms + 3));
  return pose;
}

class OnwardsInX : public Extrapolator {
 public:
  void observe(const Pose& pose, MonoTime) override { newest_ = pose; }
  void predict(MonoTime moment, Pose& out) const override {
    out = newest_;
    out.p_WH_m.x() += static_cast<float>((moment - newest_.capture_time).as_seconds());
  }

 private:
  Pose newest_;
};

struct Dance {
  explicit Dance(MotionSource::Parts parts, int poses = 60)
      : timeline(Concealment::kPoses), source(timeline, std::move(parts)) {
    for (int i = 0; i < poses; ++i) take(1000 + 20 * i);
  }
  void take(int ms) {
    timeline.take(pose_at(ms), at_ms(ms + 50));
    source.observe();
  }
  DancerTimeline timeline;
  MotionSource source;
};

TEST(MotionSource, AnswersWithWhatCameAndRepeatsTheNewest) {
  Dance dance({});
  Pose out;
  EXPECT_EQ(dance.source.at(at_ms(1510), out), Kind::kDanced);
  EXPECT_NEAR(out.p_WH_m.x(), 1.510f, 1e-4f);
  EXPECT_EQ(dance.source.at(at_ms(2200), out), Kind::kRepeated);
  EXPECT_EQ(out.capture_time, at_ms(2180));
  EXPECT_FALSE(dance.source.begin_continuation(at_ms(4000), at_ms(4050)));
}

TEST(MotionSource, PredictsUpToItsReachAndCarriesMusicAndStampsOn) {
  MotionSource::Parts parts;
  parts.extrapolator = std::make_unique<OnwardsInX>();
  parts.reach = Duration::ms(300);
  Dance dance(std::move(parts));
  Pose out;
  EXPECT_EQ(dance.source.at(at_ms(2180), out), Kind::kDanced);
  EXPECT_EQ(dance.source.at(at_ms(2280), out), Kind::kPredicted);
  EXPECT_EQ(out.capture_time, at_ms(2280));
  EXPECT_NEAR(out.p_WH_m.x(), 2.280f, 1e-4f);
  EXPECT_NEAR(out.music_beats, 4.56, 1e-6);
  EXPECT_EQ(out.stamped(Hop::kStageTaken), at_ms(2283));
  EXPECT_EQ(dance.source.at(at_ms(3180), out), Kind::kPredicted);
  EXPECT_NEAR(out.p_WH_m.x(), 2.480f, 1e-4f) << "no further than its reach";
}

TEST(MotionSource, LeadsWhatIsPredictedAndNothingElse) {
  PredictionLead lead;
  lead.set_strength(1.0f);
  for (std::size_t h = 0; h < PredictionLead::kHorizons.size(); ++h) lead.set_gain(h, 1.5f);
  MotionSource::Parts parts;
  parts.extrapolator = std::make_unique<OnwardsInX>();
  Dance dance(std::move(parts));
  Pose out;
  EXPECT_EQ(dance.source.at(at_ms(2170), out, lead), Kind::kDanced);
  EXPECT_NEAR(out.p_WH_m.x(), 2.170f, 1e-4f);
  EXPECT_EQ(dance.source.at(at_ms(2280), out, lead), Kind::kPredicted);
  EXPECT_EQ(out.capture_time, at_ms(2280));
  EXPECT_NEAR(out.p_WH_m.x(), 2.280f + 0.025f, 1e-3f) << "half of the lead is of the place";
}

TEST(MotionSource, SaysOfWhichMomentsTheNextPoseMayTellOtherwise) {
  Dance dance({});
  EXPECT_TRUE(dance.source.is_open(at_ms(2200), Kind::kPredicted));
  EXPECT_TRUE(dance.source.is_open(at_ms(2170), Kind::kDanced)) << "between the newest two";
  EXPECT_FALSE(dance.source.is_open(at_ms(2150), Kind::kDanced));
  MotionSource::Parts parts;
  parts.is_final = true;
  Dance final_dance(std::move(parts));
  EXPECT_FALSE(final_dance.source.is_open(at_ms(2170), Kind::kDanced));
}

TEST(MotionSource, ContinuesTheDanceUntilPosesComeBack) {
  MotionSource::Parts parts;
  parts.concealment = std::make_unique<Concealment>();
  Dance dance(std::move(parts), 600);
  const std::int64_t newest = 1000 + 20 * 599;
  EXPECT_FALSE(dance.source.begin_continuation(at_ms(newest + 50), at_ms(newest + 100)));
  EXPECT_TRUE(dance.source.begin_continuation(at_ms(newest + 80), at_ms(newest + 130)));
  EXPECT_FALSE(dance.source.begin_continuation(at_ms(newest + 90), at_ms(newest + 140)));
  Pose out;
  EXPECT_EQ(dance.source.at(at_ms(newest + 90), out), Kind::kContinued);
  EXPECT_EQ(out.capture_time, at_ms(newest + 90));
  dance.take(newest + 2000);
  EXPECT_FALSE(dance.source.is_continuing());
  EXPECT_EQ(dance.source.at(at_ms(newest + 2000), out), Kind::kDanced);
}

Pose with_arm(float rad, float x_m) {
  Pose pose;
  pose.R_PB[index_of(Bone::kLeftUpperArm)] =
      Eigen::Quaternionf(Eigen::AngleAxisf(rad, Eigen::Vector3f::UnitZ()));
  pose.R_PB[index_of(Bone::kLeftUpperLeg)] = pose.R_PB[index_of(Bone::kLeftUpperArm)];
  pose.p_WH_m.x() = x_m;
  return pose;
}

float turn_rad(const Pose& pose, Bone bone) {
  return Eigen::AngleAxisf(pose.R_PB[index_of(bone)]).angle();
}

TEST(PredictionLead, LeavesSteadyMotionAsItIsWhereWaysAreRight) {
  PredictionLead lead;
  EXPECT_TRUE(lead.is_none());
  lead.set_strength(1.0f);
  EXPECT_FALSE(lead.is_none());
  for (std::size_t h = 0; h < PredictionLead::kHorizons.size(); ++h) lead.set_gain(h, 1.0f);
  for (const int ms : {0, 50, 200, 300, 500, 900}) {
    Pose whole = with_arm(0.4f, 0.2f);
    add_lead(with_arm(0.0f, 0.0f), with_arm(0.2f, 0.1f), lead.at(Duration::ms(ms)), whole);
    EXPECT_NEAR(turn_rad(whole, Bone::kLeftUpperArm), 0.4f, 1e-3f) << ms;
    EXPECT_NEAR(whole.p_WH_m.x(), 0.2f, 1e-4f) << ms;
  }
}

TEST(PredictionLead, LengthensWaysOfLegsAndPlaceByHalfAndNoneBeyondItsBound) {
  PredictionLead lead;
  lead.set_strength(1.0f);
  for (std::size_t h = 0; h < PredictionLead::kHorizons.size(); ++h) lead.set_gain(h, 1.5f);
  Pose whole = with_arm(0.4f, 0.1f);
  add_lead(with_arm(0.0f, 0.0f), with_arm(0.2f, 0.05f), lead.at(Duration::ms(200)), whole);
  EXPECT_NEAR(turn_rad(whole, Bone::kLeftUpperArm), 0.6f, 1e-3f);
  EXPECT_NEAR(turn_rad(whole, Bone::kLeftUpperLeg), 0.5f, 1e-3f);
  EXPECT_NEAR(whole.p_WH_m.x(), 0.125f, 1e-3f);
  // What shrank on its second half is shown as the first half went.
  whole = with_arm(0.3f, 0.1f);
  add_lead(with_arm(0.0f, 0.0f), with_arm(0.2f, 0.1f), lead.at(Duration::ms(200)), whole);
  EXPECT_GT(turn_rad(whole, Bone::kLeftUpperArm), 1.5f * 0.3f + 0.05f);
  whole = with_arm(2.5f, 3.0f);
  add_lead(with_arm(0.0f, 0.0f), with_arm(-1.5f, -3.0f), lead.at(Duration::ms(200)), whole);
  EXPECT_LT(std::abs(turn_rad(whole, Bone::kLeftUpperArm) - 2.5f), 0.41f);
  EXPECT_LT(std::abs(whole.p_WH_m.x() - 3.0f), 0.08f);
}

TEST(PredictionLead, GrowsFromNothingWithTheDistance) {
  PredictionLead lead;
  lead.set_strength(1.0f);
  float before = 1.0f;
  for (int ms = 0; ms <= 200; ms += 10) {
    const auto shares = lead.at(Duration::ms(ms));
    const float sum = shares.of_half + shares.of_whole;
    EXPECT_GE(sum, before - 1e-6f) << ms;
    EXPECT_LT(sum, before + 0.05f) << ms;
    before = sum;
  }
  EXPECT_EQ(lead.at(Duration()).of_half + lead.at(Duration()).of_whole, 1.0f);
  EXPECT_EQ(lead.at(Duration::ms(600)).of_half, 0.0f);
  lead.set_strength(0.0f);
  EXPECT_EQ(lead.at(Duration::ms(200)).of_half, 0.0f);
  EXPECT_EQ(lead.at(Duration::ms(200)).of_whole, 1.0f);
}

TEST(LiveClock, TakesBackAsMuchOfTheDelayAsItIsToldAndNeverGoesBack) {
  for (const double lead : {0.0, 0.5, 1.0}) {
    Dance dance({}, 0);
    LiveClock clock(lead);
    MonoTime shown;
    for (int i = 0; i < 120; ++i) {
      dance.timeline.take(pose_at(1000 + 20 * i), at_ms(1100 + 20 * i));
      clock.observe(dance.timeline, dance.source);
      const auto choice = clock.choose(dance.timeline, at_ms(1100 + 20 * i), shown);
      EXPECT_GE(choice.moment, shown);
      shown = choice.moment;
    }
    EXPECT_NEAR((at_ms(1100 + 20 * 119) - shown).as_ms(), 100.0 * (1.0 - lead), 0.01);
    const auto earlier = clock.choose(dance.timeline, at_ms(1000 + 20 * 119), shown);
    EXPECT_TRUE(earlier.stands);
    EXPECT_EQ(earlier.moment, shown);
  }
}

TEST(LiveClock, ShowsPosesOfAnotherClockAsTheyCome) {
  Dance dance({}, 0);
  LiveClock clock;
  dance.timeline.take(pose_at(1000), at_ms(9'000'000));
  clock.observe(dance.timeline, dance.source);
  EXPECT_EQ(clock.choose(dance.timeline, at_ms(9'000'000), MonoTime()).moment, at_ms(1000));
}

}  // namespace
}  // namespace dance
