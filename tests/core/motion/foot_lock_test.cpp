#include "core/motion/foot_lock.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/motion/hold_odds.h"
#include "testing/motion/motion_measures.h"
#include "tests/allocation_guard.h"
#include "tests/core/pose/random_pose.h"
#include "tests/transformers/real_takes.h"

namespace dance {
namespace {

constexpr double kStage_hz = 60.0;

MonoTime frame_at(int i) { return MonoTime() + Duration::seconds(10.0 + i / kStage_hz); }

// Stands with bent knees, feet below the hips, on a floor at `floor_m`.
Pose crouching(float x_m, float floor_m = 0.0f) {
  Pose pose;
  const auto turn = [](float rad) {
    return Eigen::Quaternionf(Eigen::AngleAxisf(rad, Eigen::Vector3f::UnitX()));
  };
  for (const Limb& leg : {kLeftLeg, kRightLeg}) {
    pose.R_PB[index_of(leg.upper)] = turn(-0.4f);
    pose.R_PB[index_of(leg.lower)] = turn(0.8f);
    pose.R_PB[index_of(leg.end)] = turn(-0.4f);
  }
  pose.p_WH_m = Eigen::Vector3f(x_m, 0.87f + floor_m, 0.0f);
  return pose;
}

Eigen::Vector3f ball(const Pose& pose, Bone bone = Bone::kLeftToes) {
  BodyFrames frames;
  forward_kinematics(average_skeleton(), pose, frames);
  return frames.position(bone);
}

TEST(FootLock, HoldsFeetThatStandWhileTheBodyDrifts) {
  for (const float floor_m : {0.0f, -3.0f, 1.7f}) {
    FootLock lock;
    Eigen::Vector3f held = Eigen::Vector3f::Zero();
    for (int i = 0; i < 90; ++i) {
      // Skates at 0.1 m/s.
      Pose pose = crouching(0.1f * static_cast<float>(i) / 60.0f, floor_m);
      const Pose raw = pose;
      lock.apply(frame_at(i), pose);
      if (i == 30) held = ball(pose);
      if (i > 30 && i <= 60) {
        EXPECT_TRUE(lock.is_locked(0) && lock.is_locked(1));
        EXPECT_LT((ball(pose) - held).norm(), 1e-3f) << "floor at " << floor_m << ", frame " << i;
        EXPECT_EQ(pose.p_WH_m, raw.p_WH_m);
        EXPECT_EQ(pose.R_PB[index_of(Bone::kHead)].coeffs(),
                  raw.R_PB[index_of(Bone::kHead)].coeffs());
      }
    }
  }
}

TEST(FootLock, KeepsTheFootsOwnTurnAndTheBonesLengths) {
  FootLock lock;
  for (int i = 0; i < 60; ++i) {
    Pose pose = crouching(0.1f * static_cast<float>(i) / 60.0f);
    BodyFrames raw, moved;
    const Skeleton skeleton = average_skeleton();
    forward_kinematics(skeleton, pose, raw);
    lock.apply(frame_at(i), pose);
    forward_kinematics(skeleton, pose, moved);
    const std::size_t foot = index_of(Bone::kLeftFoot);
    EXPECT_LT(moved.R_WB[foot].angularDistance(raw.R_WB[foot]), 2e-3f);
    EXPECT_NEAR((moved.position(Bone::kLeftLowerLeg) - moved.position(Bone::kLeftUpperLeg)).norm(),
                skeleton.offset(Bone::kLeftLowerLeg).norm(), 1e-4f);
    for (const auto& q : pose.R_PB) EXPECT_NEAR(q.norm(), 1.0f, 1e-4f);
  }
}

TEST(FootLock, LetsGoSmoothlyWhenTheFootLifts) {
  FootLock lock;
  Eigen::Vector3f before = Eigen::Vector3f::Zero();
  float fastest_m = 0.0f, apart_m = 0.0f;
  for (int i = 0; i < 180; ++i) {
    const float drift_m = 0.1f * static_cast<float>(std::min(i, 60)) / 60.0f;
    Pose pose = crouching(drift_m);
    // From 1 s on the dancer jumps up at 0.6 m/s for a third of a second.
    pose.p_WH_m.y() += 0.6f * static_cast<float>(std::clamp(i - 60, 0, 20)) / 60.0f;
    const Eigen::Vector3f raw = ball(pose);
    lock.apply(frame_at(i), pose);
    const Eigen::Vector3f shown = ball(pose);
    if (i > 0) fastest_m = std::max(fastest_m, (shown - before).norm());
    before = shown;
    apart_m = (shown - raw).norm();
    if (i == 60) {
      EXPECT_GT(apart_m, 0.05f);
    }
    if (i > 70 && i < 80) {
      EXPECT_FALSE(lock.is_locked(0));
    }
  }
  EXPECT_LT(apart_m, 1e-3f);
  EXPECT_LT(fastest_m * 60.0f, 2.0f) << "the foot itself moves at 0.6 m/s";
}

TEST(FootLock, LeavesFeetThatMoveAndFeetInTheAirAlone) {
  FootLock lock;
  for (int i = 0; i < 120; ++i) {
    Pose pose = crouching(1.0f * static_cast<float>(i) / 60.0f);
    const Pose raw = pose;
    EXPECT_FALSE(lock.apply(frame_at(i), pose)) << i;
    EXPECT_EQ(pose.R_PB[index_of(Bone::kLeftUpperLeg)].coeffs(),
              raw.R_PB[index_of(Bone::kLeftUpperLeg)].coeffs());
  }
  lock.clear();
  // One foot is held up and still: only the other is on the floor.
  for (int i = 0; i < 60; ++i) {
    Pose pose = crouching(0.0f);
    pose.R_PB[index_of(Bone::kLeftUpperLeg)] =
        Eigen::Quaternionf(Eigen::AngleAxisf(-1.4f, Eigen::Vector3f::UnitX()));
    lock.apply(frame_at(i), pose);
  }
  EXPECT_FALSE(lock.is_locked(0));
  EXPECT_TRUE(lock.is_locked(1));
}

// The prediction skates at a speed at which no foot is taken to stand.
TEST(FootLock, HoldsFeetAsLongAsTheyAreForeseenToStand) {
  for (const bool foresees : {false, true}) {
    FootLock lock;
    Eigen::Vector3f held = Eigen::Vector3f::Zero();
    float furthest_m = 0.0f;
    for (int i = 0; i < 90; ++i) {
      Pose pose = crouching(0.3f * static_cast<float>(i) / 60.0f);
      // From frame 50 on it is foreseen to step.
      const float step_m = i < 50 ? 0.0f : 0.2f;
      if (foresees) {
        // It was seen to go just before.
        Pose real = crouching(i < 45 ? 0.0f : 0.05f * static_cast<float>(i - 45));
        real.capture_time = frame_at(i);
        lock.observe(real, frame_at(i));
        lock.foresee(crouching(-step_m), crouching(0.0f), crouching(step_m), Duration::ms(200));
      }
      const Pose raw = pose;
      lock.apply(frame_at(i), pose);
      if (i == 20) held = ball(pose);
      if (i > 20 && i < 40) furthest_m = std::max(furthest_m, (ball(pose) - held).norm());
      if (i == 89) {
        EXPECT_LT((ball(pose) - ball(raw)).norm(), 0.01f) << "goes back to the dance";
      }
    }
    if (foresees) {
      EXPECT_LT(furthest_m, 0.01f);
    } else {
      EXPECT_GT(furthest_m, 0.05f);
    }
  }
}

TEST(FootLock, WhatIsForeseenIsOfOnePictureAlone) {
  FootLock lock;
  const Pose stands = crouching(0.0f);
  for (int i = 0; i < 10; ++i) {
    lock.foresee(stands, stands, stands, Duration::ms(200));
    Pose pose = crouching(0.6f * static_cast<float>(i) / 60.0f);
    lock.apply(frame_at(i), pose);
  }
  EXPECT_TRUE(lock.is_locked(0));
  Pose pose = crouching(0.1f);
  lock.apply(frame_at(10), pose);
  EXPECT_FALSE(lock.is_locked(0));
}

TEST(FootLock, LeavesNoFootBehindHoweverLikelyItStands) {
  FootLock lock;
  const Pose stands = crouching(0.0f);
  for (int i = 0; i < 120; ++i) {
    lock.foresee(stands, stands, stands, Duration::ms(i % 2 ? 20 : 200));
    Pose pose = crouching(2.0f * static_cast<float>(i) / 60.0f);
    const Pose raw = pose;
    lock.apply(frame_at(i), pose);
    EXPECT_LT((ball(pose) - ball(raw)).norm(), 0.4f) << i;
  }
}

// Feet that stand are foreseen with odds from -1 to 1, in steps.
TEST(HoldOdds, FindTheOddsThatNearlyAllFeetHadThatThenStood) {
  for (const float shift : {0.0f, -1.0f}) {
    HoldOdds odds;
    EXPECT_EQ(odds.value(), HoldOdds::kUsual);
    double missed = 0.0, seen = 0.0;
    for (int i = 0; i < 6000; ++i) {
      const float foreseen = shift + 0.02f * static_cast<float>(i * 37 % 101) - 1.0f;
      odds.foresee(frame_at(i), {foreseen, 5.0f});
      if (i > 3000) {
        seen += 1.0;
        missed += foreseen < odds.value() ? 1.0 : 0.0;
      }
      odds.see(frame_at(i), {true, false});
    }
    EXPECT_NEAR(odds.value(), shift - 0.9f, 0.15f);
    EXPECT_LT(missed / seen, 0.1);
    EXPECT_GT(missed / seen, 0.01);
  }
}

TEST(HoldOdds, LearnOfNothingButFeetThatStoodAndWereForeseenAndStayBounded) {
  HoldOdds odds;
  for (int i = 0; i < 100; ++i) {
    odds.foresee(frame_at(i), {-9.0f, -9.0f});
    odds.see(frame_at(i), {false, false});
    odds.see(frame_at(i) + Duration::s(5), {true, true});
  }
  EXPECT_EQ(odds.value(), HoldOdds::kUsual);
  for (int i = 0; i < 1000; ++i) {
    odds.foresee(frame_at(i), {-9.0f, -9.0f});
    odds.see(frame_at(i), {true, true});
  }
  EXPECT_EQ(odds.value(), HoldOdds::kLeast);
  for (int i = 0; i < 1000; ++i) {
    odds.foresee(frame_at(i), {9.0f, 9.0f});
    odds.see(frame_at(i), {true, true});
  }
  EXPECT_EQ(odds.value(), HoldOdds::kMost);
  odds.clear();
  EXPECT_EQ(odds.value(), HoldOdds::kUsual);
}

TEST(FootLock, TheFloorIsThatOfPosesThatCame) {
  FootLock lock;
  for (int i = 0; i < 120; ++i) {
    Pose real = crouching(0.0f);
    real.capture_time = frame_at(i);
    lock.observe(real, frame_at(i));
    // Predictions that sink into it, and come back.
    Pose pose = crouching(0.0f, i < 60 ? -0.2f : 0.0f);
    const Pose there = pose;
    lock.foresee(there, there, there, Duration::ms(100));
    lock.apply(frame_at(i), pose);
  }
  EXPECT_TRUE(lock.is_locked(0) && lock.is_locked(1));
}

TEST(FootLock, NeverStretchesALegBeyondItsReach) {
  FootLock::Settings settings;
  settings.furthest_m = 3.0f;
  settings.release_above_m = 3.0f;
  settings.release_above_m_s = 100.0f;
  FootLock lock(settings);
  const Skeleton skeleton = average_skeleton();
  for (int i = 0; i < 120; ++i) {
    Pose pose = crouching(0.0f);
    if (i > 30) pose.p_WH_m.y() += 0.02f * static_cast<float>(i - 30);
    lock.apply(frame_at(i), pose);
    BodyFrames frames;
    forward_kinematics(skeleton, pose, frames);
    EXPECT_LE((frames.position(Bone::kLeftFoot) - frames.position(Bone::kLeftUpperLeg)).norm(),
              skeleton.offset(Bone::kLeftLowerLeg).norm() +
                  skeleton.offset(Bone::kLeftFoot).norm() + 1e-4f);
    EXPECT_TRUE(is_valid(pose));
  }
}

TEST(FootLock, AFootSeenToStandStaysWhereItWasSeenWhateverThePredictionDoes) {
  FootLock lock;
  Eigen::Vector3f before = Eigen::Vector3f::Zero();
  for (int i = 0; i < 90; ++i) {
    Pose real = crouching(0.0f);
    real.capture_time = frame_at(i);
    lock.observe(real, frame_at(i));
    // The prediction wanders by 4 cm at up to 0.5 m/s, as predictions do.
    Pose prediction = crouching(0.04f * std::sin(0.2f * static_cast<float>(i)));
    lock.apply(frame_at(i), prediction);
    const Eigen::Vector3f shown = ball(prediction);
    if (i > 45) {
      EXPECT_LT((shown - before).norm() * 60.0f, 0.02f) << i;
      EXPECT_LT((shown - ball(crouching(0.0f))).norm(), 0.02f) << "where it really stands";
    }
    before = shown;
  }
}

TEST(FootLock, LetsGoWhereItMayNotLockAndIsExactAfterwards) {
  FootLock lock;
  for (int i = 0; i < 40; ++i) {
    Pose pose = crouching(0.1f * static_cast<float>(i) / 60.0f);
    lock.apply(frame_at(i), pose);
  }
  bool is_moved = true;
  for (int i = 40; i < 160; ++i) {
    Pose pose = crouching(0.1f * 40.0f / 60.0f);
    const Pose raw = pose;
    is_moved = lock.apply(frame_at(i), pose, false);
    if (!is_moved) {
      for (std::size_t b = 0; b < kBoneCount; ++b)
        EXPECT_EQ(pose.R_PB[b].coeffs(), raw.R_PB[b].coeffs());
    }
  }
  EXPECT_FALSE(is_moved);
}

TEST(FootLock, StaysABodyWhateverComesIn) {
  FootLock lock;
  Random random(3);
  MonoTime now = frame_at(0);
  for (int i = 0; i < 4000; ++i) {
    Pose pose = i % 5 ? crouching(0.001f * static_cast<float>(i)) : random_pose(random);
    Pose real = random_pose(random);
    real.capture_time = now;
    if (i % 3 == 0) lock.observe(real, now);
    lock.apply(now, pose);
    ASSERT_TRUE(is_valid(pose)) << i;
    now += Duration::ms(static_cast<std::int64_t>(random.uniform(-30.0, 50.0)));
    if (i % 97 == 0) now += Duration::s(i % 2 ? 100'000 : -90'000);
  }
  Pose broken = crouching(0.0f);
  broken.p_WH_m.x() = std::numeric_limits<float>::quiet_NaN();
  EXPECT_FALSE(lock.apply(now, broken));
  Pose pose = crouching(0.0f);
  lock.apply(now + Duration::ms(16), pose);
  EXPECT_TRUE(is_valid(pose));
  Skeleton nobody = average_skeleton();
  for (auto& offset : nobody.offset_m) offset.setZero();
  lock.set_body(nobody);
  for (int i = 0; i < 100; ++i) {
    Pose p = crouching(0.0f);
    lock.apply(frame_at(i), p);
    ASSERT_TRUE(is_valid(p));
  }
}

TEST(FootLock, AllocatesNothing) {
  FootLock lock;
  Pose pose = crouching(0.0f);
  AllocationGuard guard;
  for (int i = 0; i < 200; ++i) {
    Pose out = pose;
    lock.apply(frame_at(i), out);
  }
  EXPECT_EQ(guard.allocations(), 0u);
}

TEST(FootLock, MakesRealFeetSlideLessAndTheDanceHardlyDifferent) {
  for (const RealTake& take : real_takes({"cmu_60_05_salsa", "cmu_61_12_salsa"})) {
    FootLock lock;
    lock.set_body(take.skeleton);
    std::vector<Pose> shown = take.poses;
    for (Pose& pose : shown) lock.apply(pose.capture_time, pose);
    const JointTrack truth(take.skeleton, take.poses, take.hz);
    const JointTrack held(take.skeleton, shown, take.hz);
    const Stance stance = stance_of(truth);
    EXPECT_LT(slide_m_s(held, stance), 0.6 * slide_m_s(truth, stance)) << take.name;
    EXPECT_LT(world_error_m(held, truth, 0, truth.size()), 0.004) << take.name;
    EXPECT_LT(jerk_m_s3(held, Places::kWorld), 1.1 * jerk_m_s3(truth, Places::kWorld));
  }
}

}  // namespace
}  // namespace dance
