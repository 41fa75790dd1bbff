#include "consumers/engine/adapter/prediction.h"

#include <gtest/gtest.h>

#include <cmath>

#include "consumers/engine/stage_lag.h"
#include "core/pose/kinematics.h"
#include "tests/core/pose/random_pose.h"

namespace dance::engine {
namespace {

constexpr MonoTime kBegin = MonoTime::from_ns(50'000'000'000);

// A dancer who turns, steps and bends at a steady speed.
Pose moving(double t_s, float turn_rad_per_s = 3.0f) {
  Pose pose;
  const auto t = static_cast<float>(t_s);
  for (std::size_t b = 0; b < kBoneCount; ++b)
    pose.R_PB[b] = Eigen::Quaternionf(Eigen::AngleAxisf(
        turn_rad_per_s * t, Eigen::Vector3f(1.0f, static_cast<float>(b), 2.0f).normalized()));
  pose.p_WH_m = Eigen::Vector3f(1.5f * t, 0.9f, -0.5f * t);
  pose.capture_time = kBegin + Duration::seconds(t_s);
  pose.music_beats = 2.0 * t_s;
  return pose;
}

PoseHistory moved(double hz, int poses = 10, float turn_rad_per_s = 3.0f) {
  PoseHistory history(32);
  for (int i = 0; i < poses; ++i) history.push(moving(i / hz, turn_rad_per_s));
  return history;
}

MonoTime after(const PoseHistory& history, double ms) {
  return history.newest().capture_time + Duration::seconds(ms * 1e-3);
}

float rotation_error_rad(const Pose& a, const Pose& b) {
  float largest = 0.0f;
  for (std::size_t i = 0; i < kBoneCount; ++i)
    largest = std::max(largest, a.R_PB[i].angularDistance(b.R_PB[i]));
  return largest;
}

TEST(EnginePrediction, GoesOnAsTheMotionWasForTheTimeOfAFrame) {
  for (const double hz : {30.0, 60.0, 90.0, 240.0}) {
    const PoseHistory history = moved(hz);
    const Pose predicted = predict(history, after(history, 11.0));
    const Pose wanted = moving((history.newest().capture_time - kBegin).as_seconds() + 0.011);
    EXPECT_LT(rotation_error_rad(predicted, wanted), 0.003f) << hz;
    EXPECT_LT((predicted.p_WH_m - wanted.p_WH_m).norm(), 0.001f) << hz;
    EXPECT_NEAR(predicted.music_beats, wanted.music_beats, 1e-6);
    EXPECT_EQ(predicted.capture_time, after(history, 11.0));
  }
}

TEST(EnginePrediction, BeginsAtTheNewestPose) {
  const PoseHistory history = moved(60.0);
  const Pose predicted = predict(history, history.newest().capture_time);
  EXPECT_LT(rotation_error_rad(predicted, history.newest()), 1e-3f);
  EXPECT_EQ(predicted.p_WH_m, history.newest().p_WH_m);
}

TEST(EnginePrediction, ComesToRestWithoutACornerAndStaysThere) {
  const PoseHistory history = moved(60.0);
  Pose before = history.newest();
  float last_step = 1.0f;
  for (int ms = 1; ms <= 100; ++ms) {
    const Pose now = predict(history, after(history, ms));
    const float step = (now.p_WH_m - before.p_WH_m).norm();
    EXPECT_LT(step, last_step + 1e-6f) << "it gets faster at " << ms << " ms";
    EXPECT_TRUE(ms == 1 || last_step - step < 5e-5f) << "a corner at " << ms << " ms";
    last_step = step;
    before = now;
  }
  EXPECT_LT(last_step, 2e-6f) << "it does not rest";
  const Pose much_later = predict(history, after(history, 60'000.0));
  EXPECT_EQ(much_later.p_WH_m, before.p_WH_m);
  EXPECT_LT(rotation_error_rad(much_later, before), 1e-3f);
  // Half of what the speed would have made of it.
  const float way = (much_later.p_WH_m - history.newest().p_WH_m).norm();
  EXPECT_NEAR(way, 0.5f * 0.1f * std::hypot(1.5f, 0.5f), 1e-3f);
}

TEST(EnginePrediction, KeepsRotationsUnitAndBonesLongWhateverTheMotion) {
  Random random(9);
  const Skeleton skeleton = average_skeleton();
  for (int round = 0; round < 200; ++round) {
    PoseHistory history(32);
    MonoTime t = kBegin;
    for (int i = 0; i < 5; ++i) {
      Pose pose = random_pose(random);
      pose.capture_time = t += Duration::us(100 + static_cast<std::int64_t>(random.below(40'000)));
      history.push(pose);
    }
    const Pose predicted = predict(history, after(history, random.uniform(0.0, 200.0)));
    EXPECT_TRUE(is_valid(predicted));
    for (const auto& q : predicted.R_PB) EXPECT_NEAR(q.norm(), 1.0f, 1e-5f);
    EXPECT_LE((predicted.p_WH_m - history.newest().p_WH_m).norm(), kMostPredicted_m + 1e-4f);
    EXPECT_LT(rotation_error_rad(predicted, history.newest()), 3.15f);
    BodyFrames frames;
    forward_kinematics(skeleton, predicted, frames);
    for (std::size_t b = 1; b < kBoneCount; ++b) {
      const auto parent = static_cast<std::size_t>(kBones[b].parent);
      EXPECT_NEAR((frames.p_WB_m[b] - frames.p_WB_m[parent]).norm(), skeleton.offset_m[b].norm(),
                  1e-4f);
    }
  }
}

TEST(EnginePrediction, OfThePosesOfTheMemoryIsTheSame) {
  const auto stored = [](const Pose& pose) {
    StoredPose out{};
    for (std::size_t b = 0; b < kBoneCount; ++b)
      Eigen::Vector4f::Map(out.rotation_xyzw[b]) = pose.R_PB[b].coeffs();
    Eigen::Vector3f::Map(out.hips_m) = pose.p_WH_m;
    out.capture_ns = pose.capture_time.since_zero_ns();
    out.music_beats = pose.music_beats;
    return out;
  };
  const PoseHistory history = moved(60.0);
  for (const double ms : {0.0, 3.0, 40.0, 100.0, 500.0}) {
    StoredPose newest = stored(history.newest());
    predict(newest, stored(history.newest(1)), after(history, ms));
    const Pose wanted = predict(history, after(history, ms));
    for (std::size_t b = 0; b < kBoneCount; ++b)
      EXPECT_EQ(Eigen::Vector4f(newest.rotation_xyzw[b]), wanted.R_PB[b].coeffs());
    EXPECT_EQ(Eigen::Vector3f(newest.hips_m), wanted.p_WH_m);
    EXPECT_EQ(newest.music_beats, wanted.music_beats);
  }
}

TEST(EnginePrediction, WithoutASpeedTheNewestStays) {
  PoseHistory history(32);
  history.push(moving(0.0));
  EXPECT_EQ(predict(history, after(history, 30.0)).p_WH_m, history.newest().p_WH_m);
  // The pose before is a second away: that was another motion.
  history.push(moving(1.0));
  EXPECT_EQ(predict(history, after(history, 30.0)).p_WH_m, history.newest().p_WH_m);
}

TEST(StageLag, IsTheLeastDelayOfTheLastSecond) {
  StageLag lag;
  Random random(4);
  Duration smooth;
  MonoTime t = kBegin;
  for (int i = 0; i < 600; ++i) {
    t += Duration::us(16'667);
    smooth = lag.add(
        Duration::ms(40) + Duration::us(static_cast<std::int64_t>(random.below(30'000))), t);
  }
  EXPECT_NEAR(smooth.as_ms(), 40.0, 3.0);
}

TEST(StageLag, FollowsAChangeWithoutHurry) {
  StageLag lag;
  MonoTime t = kBegin;
  Duration last = lag.add(Duration::ms(50), t);
  EXPECT_EQ(last, Duration::ms(50));
  for (const Duration wanted : {Duration::ms(130), Duration::ms(50)}) {
    for (int i = 0; i < 600; ++i) {
      t += Duration::us(16'667);
      const Duration now = lag.add(wanted, t);
      EXPECT_LE(std::max(now - last, last - now), Duration::us(16'667) / StageLag::kSlowness);
      last = now;
    }
    EXPECT_EQ(last, wanted);
  }
}

TEST(StageLag, AJumpUpIsFollowedWhenItHasStayedAndOneDownAtOnce) {
  for (const double hz : {10.0, 60.0, 240.0}) {
    StageLag lag;
    MonoTime t = kBegin;
    lag.add(Duration::ms(50), t);
    const auto add = [&](Duration delay, Duration span) {
      Duration now;
      for (const MonoTime end = t + span; t < end;)
        now = lag.add(delay, t += Duration::period_of_hz(hz));
      return now;
    };
    EXPECT_EQ(add(Duration::ms(50), Duration::s(2)), Duration::ms(50));
    EXPECT_EQ(add(Duration::ms(900), StageLag::kStays - Duration::ms(110)), Duration::ms(50)) << hz;
    EXPECT_EQ(add(Duration::ms(900), Duration::ms(320)), Duration::ms(900)) << hz;
    EXPECT_EQ(lag.add(-Duration::ms(80), t + Duration::ms(2)), -Duration::ms(80)) << hz;
  }
}

// Poses are captured on and on; none comes for a while, then all at once.
TEST(StageLag, AfterAStallAndItsBurstItIsWhatItWasWithinAFewPoses) {
  constexpr Duration kDelay = Duration::ms(20), kFrame = Duration::us(11'111);
  for (const Duration stall : {Duration::ms(300), Duration::ms(900), Duration::ms(1800)}) {
    StageLag lag;
    MonoTime captured = kBegin;
    for (int i = 0; i < 200; ++i) lag.add(kDelay, (captured += kFrame) + kDelay);
    const MonoTime burst = captured + stall + kDelay;
    int pose = 0;
    for (MonoTime shown = burst; captured + kFrame + kDelay <= shown; shown += Duration::us(50)) {
      captured += kFrame;
      EXPECT_LE(lag.add(shown - captured, shown), kDelay + Duration::ms(2)) << "pose " << pose;
      ++pose;
    }
    EXPECT_GT(pose, 20);
    for (int i = 0; i < 200; ++i)
      EXPECT_NEAR(lag.add(kDelay, (captured += kFrame) + kDelay).as_ms(), 20.0, 2.0) << i;
  }
}

TEST(StageLag, ASinglePoseThatIsLateChangesNothing) {
  StageLag lag;
  MonoTime t = kBegin;
  for (int i = 0; i < 300; ++i) {
    const Duration delay = Duration::ms(i == 150 ? 320 : 20);
    EXPECT_EQ(lag.add(delay, t += Duration::us(16'667)), Duration::ms(20)) << i;
  }
}

TEST(StageLag, TimesThatGoBackAreNoHarm) {
  StageLag lag;
  Random random(7);
  MonoTime t = kBegin;
  Duration now;
  for (int i = 0; i < 600; ++i) {
    t += Duration::us(16'667);
    now = lag.add(Duration::ms(40),
                  t - Duration::us(static_cast<std::int64_t>(random.below(40'000))));
    EXPECT_EQ(now, Duration::ms(40));
  }
  EXPECT_EQ(lag.add(Duration::ms(70), t - Duration::s(60)), Duration::ms(70)) << "another clock";
}

TEST(StageLag, ARecordingThatWasPausedIsFollowedAtOnce) {
  StageLag lag;
  lag.add(Duration::ms(40), kBegin);
  EXPECT_EQ(lag.add(Duration::s(10), kBegin + Duration::s(10)), Duration::s(10));
}

}  // namespace
}  // namespace dance::engine
