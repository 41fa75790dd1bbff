#include <gtest/gtest.h>

#include <algorithm>

#include "tests/allocation_guard.h"
#include "tests/transformers/flows.h"
#include "tests/transformers/predicted_dances.h"
#include "transformers/predict/dance_extrapolator.h"

namespace dance {
namespace {

constexpr Duration kWay = Duration::ms(100);

Flow predicting(const char* word = "predict") { return *Flow::make({word}); }

TEST(Predict, ShowsTheDancerAsTheyAreNow) {
  Flow station = predicting();
  const auto dance = shaken(salsa(1200), 0.002);
  double ours = 0.0, raw = 0.0;
  Pose out;
  EXPECT_FALSE(station.sample(MonoTime::from_us(1), out));
  for (std::size_t i = 6; i < dance.size(); ++i) {
    const MonoTime now = dance[i - 6].capture_time + kWay;
    station.observe(dance[i - 6], now);
    ASSERT_TRUE(station.sample(now, out));
    if (i < 300) continue;
    EXPECT_EQ(out.capture_time, now);
    ours += mean_angle_rad(out, dance[i]);
    raw += mean_angle_rad(dance[i - 6], dance[i]);
  }
  // Corrections that die away, feet that stand and joints within their limits give a part of it
  // back.
  EXPECT_LT(ours, 0.8 * raw);
}

TEST(Predict, TakesBackAsMuchAsItIsTold) {
  Flow station = predicting("predict lead=0.5");
  const auto dance = salsa(300);
  Pose out;
  for (const Pose& pose : dance) station.observe(pose, pose.capture_time + kWay);
  ASSERT_TRUE(station.sample(dance.back().capture_time + kWay, out));
  EXPECT_NEAR((out.capture_time - dance.back().capture_time).as_ms(), 50.0, 1.0);
}

TEST(Predict, AnyMomentMayBeAskedForWithoutAChangeToWhatIsShown) {
  DancerTimeline timeline(512);
  MotionSource::Parts parts;
  parts.extrapolator = std::make_unique<DanceExtrapolator>();
  MotionSource source(timeline, std::move(parts));
  for (const Pose& pose : shaken(salsa(400), 0.004)) {
    timeline.take(pose, pose.capture_time + kWay);
    source.observe();
    Pose first, other, again;
    const MonoTime moment = pose.capture_time + kWay;
    EXPECT_EQ(source.at(moment, first), MotionSource::Kind::kPredicted);
    for (int ahead = -200; ahead < 700; ahead += 150)
      source.at(moment + Duration::ms(ahead), other);
    source.at(moment, again);
    ASSERT_EQ(first.R_PB[9].coeffs(), again.R_PB[9].coeffs());
  }
}

TEST(Predict, ASourceThatMakesGapsAllTheTimeCostsNoMoreThanADancer) {
  DanceExtrapolator extrapolator;
  const Pose pose = salsa(1)[0];
  MonoTime capture = pose.capture_time, now = capture;
  // Nine tenths of a second between captures, six hundred of them a second: fifty rows each, if all
  // were filled.
  for (int i = 0; i < 6000; ++i) {
    capture += Duration::ms(900);
    now += Duration::us(1667);
    Pose next = pose;
    next.capture_time = capture;
    extrapolator.observe(next, now);
  }
  // Ten seconds of arrivals: each pose is one row, and what a dance has beside.
  EXPECT_LT(extrapolator.rows_taken(), 6000u + 10u * 90u + 200u);
}

// A pose that comes late corrects what was shown without a pop: no step between two frames is much
// larger than the dance's own.
TEST(Predict, CorrectsWithoutAPop) {
  Flow station = predicting();
  const auto dance = shaken(salsa(1800), 0.004);
  Random random(2);
  double most = 0.0, own = 0.0;
  Pose before, out;
  std::size_t heard = 0;
  for (std::size_t i = 30; i < dance.size(); ++i) {
    const MonoTime now = dance[i].capture_time;
    // Six to ten frames late, in bursts.
    const std::size_t late = 6 + random.below(5);
    for (; heard + late < i; ++heard) station.observe(dance[heard], now);
    ASSERT_TRUE(station.sample(now, out));
    if (i > 600) {
      most = std::max(most, mean_angle_rad(out, before));
      own = std::max(own, mean_angle_rad(dance[i], dance[i - 1]));
    }
    before = out;
  }
  EXPECT_LT(most, 1.5 * own);
}

TEST(Predict, BehindAHoldShowsItsMomentAndFillsWhatIsLate) {
  auto flow = Flow::make({"hold 40ms", "predict"});
  ASSERT_TRUE(flow);
  Hold alone(Duration::ms(40));
  const auto dance = salsa(600);
  Pose out, held;
  for (std::size_t i = 0; i < dance.size(); ++i) {
    const MonoTime now = dance[i].capture_time + kWay;
    // A tenth of a second is missing now and then.
    if (i % 100 < 94) {
      flow->observe(dance[i], now);
      alone.observe(dance[i], now);
    }
    ASSERT_TRUE(flow->sample(now, out));
    ASSERT_TRUE(alone.sample(now, held));
    if (i < 200) continue;
    if (i % 100 < 90) {
      EXPECT_LT(std::abs((out.capture_time - held.capture_time).as_ms()), 0.1);
    }
    // The hold stands where it has nothing; the prediction's time goes on.
    if (i % 100 == 99) {
      EXPECT_GT(out.capture_time, held.capture_time + Duration::ms(20));
    }
  }
}

TEST(Predict, MusicGoesOnWithTheDance) {
  Flow station = predicting();
  auto dance = salsa(300);
  for (std::size_t i = 0; i < dance.size(); ++i) {
    dance[i].music_beats = 3.0 * static_cast<double>(i) / 60.0;
    station.observe(dance[i], dance[i].capture_time + kWay);
  }
  Pose out;
  ASSERT_TRUE(station.sample(dance.back().capture_time + kWay, out));
  EXPECT_NEAR(out.music_beats, dance.back().music_beats + 0.3, 1e-3);
  ASSERT_TRUE(is_valid(out));
}

TEST(Predict, PosesOfAnotherClockAreShownAsTheyCome) {
  Flow station = predicting();
  const auto dance = salsa(300);
  Pose out;
  for (const Pose& pose : dance) station.observe(pose, pose.capture_time + Duration::s(100000));
  ASSERT_TRUE(station.sample(dance.back().capture_time + Duration::s(100000), out));
  EXPECT_NEAR((out.capture_time - dance.back().capture_time).as_ms(), 0.0, 1.0);
}

TEST(Predict, CountsWhatItRefusesWhatStartsAnewAndWhatItCannotReach) {
  Flow station = predicting();
  const auto dance = salsa(100);
  for (const Pose& pose : dance) station.observe(pose, pose.capture_time + kWay);
  station.observe(dance[50], dance.back().capture_time + kWay);
  EXPECT_EQ(station.counters().refused, 1u);
  Pose out;
  ASSERT_TRUE(station.sample(dance.back().capture_time + Duration::ms(900), out));
  EXPECT_EQ(station.counters().starved, 1u);
  Pose other = dance[0];
  other.clock_id = 2;
  station.observe(other, dance.back().capture_time + Duration::s(1));
  EXPECT_EQ(station.counters().restarts, 1u);
}

TEST(Predict, AllocatesNothing) {
  Flow station = predicting();
  const auto dance = shaken(salsa(900), 0.004);
  const AllocationGuard guard;
  Pose out;
  for (const Pose& pose : dance) {
    station.observe(pose, pose.capture_time + kWay);
    station.sample(pose.capture_time + kWay, out);
  }
  EXPECT_EQ(guard.allocations(), 0u);
}

// 25 rad/s is faster than a prediction may be, but it was danced.
TEST(Predict, WithoutALeadShowsAKickAsItWasDanced) {
  for (const bool is_behind_hold : {false, true}) {
    auto flow =
        is_behind_hold ? Flow::make({"hold 0ms", "predict"}) : Flow::make({"predict lead=0"});
    ASSERT_TRUE(flow);
    auto dance = salsa(240);
    const std::size_t shank = index_of(Bone::kRightLowerLeg);
    for (std::size_t i = 200; i < 206; ++i)
      dance[i].R_PB[shank] = exp_rotation(
          Eigen::Vector3f(25.0f / 60.0f * static_cast<float>(std::min(i, 406 - i) - 199), 0, 0));
    for (std::size_t i = 0; i < dance.size(); ++i) {
      const MonoTime now = dance[i].capture_time + kWay;
      flow->observe(dance[i], now);
      Pose out;
      ASSERT_TRUE(flow->sample(now, out));
      if (i < 60) continue;
      ASSERT_EQ(out.capture_time, dance[i].capture_time);
      for (std::size_t b = 0; b < kBoneCount; ++b)
        ASSERT_EQ(out.R_PB[b].coeffs(), dance[i].R_PB[b].coeffs()) << i << " " << kBones[b].name;
    }
  }
}

TEST(Predict, ForgetsADancerWhenAnotherBodyComesAndNotWhenTheSameIsMeasuredAgain) {
  Flow station = predicting();
  const auto personal = std::static_pointer_cast<PersonalModel>(station.learner());
  Skeleton body = average_skeleton();
  station.set_body(body);
  for (const Pose& pose : salsa(900)) {
    station.observe(pose, pose.capture_time + kWay);
    personal->learn();
  }
  bool is_new = false;
  ASSERT_NE(personal->weights(is_new), nullptr);
  for (auto& offset_m : body.offset_m) offset_m *= 1.01f;
  station.set_body(body);
  EXPECT_NE(personal->weights(is_new), nullptr);
  for (auto& offset_m : body.offset_m) offset_m *= 1.15f;
  station.set_body(body);
  EXPECT_EQ(personal->weights(is_new), nullptr);
}

TEST(Predict, RefusesSettingsThatMakeNoSense) {
  EXPECT_TRUE(Flow::make({"predict lead=0.8 most=200ms"}));
  for (const char* text : {"predict lead=2", "predict most=5s", "predict lead", "predict far=1"})
    EXPECT_FALSE(Flow::make({text})) << text;
}

}  // namespace
}  // namespace dance
