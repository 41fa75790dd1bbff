#include "transformers/conceal/continuation.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/pose/heading.h"
#include "core/pose/interpolate.h"
#include "testing/motion/motion_measures.h"
#include "tests/allocation_guard.h"
#include "tests/core/pose/random_pose.h"
#include "tests/transformers/real_takes.h"

namespace dance {
namespace {

constexpr double kDance_hz = 60.0;
constexpr double kStep_s = 1.6;  // a step that repeats

Eigen::Quaternionf turn_about(float rad, const Eigen::Vector3f& axis) {
  return Eigen::Quaternionf(Eigen::AngleAxisf(rad, axis));
}

// A dance that repeats exactly: arms and hips swing, and the dancer sways.
Pose dance_pose(double t_s) {
  Pose pose;
  const auto phase = static_cast<float>(2.0 * M_PI * t_s / kStep_s);
  pose.R_PB[0] = turn_about(0.3f * std::sin(phase), Eigen::Vector3f::UnitY());
  pose.R_PB[index_of(Bone::kLeftUpperArm)] =
      turn_about(0.8f * std::sin(phase) + 0.2f * std::sin(2.0f * phase), Eigen::Vector3f::UnitZ());
  pose.R_PB[index_of(Bone::kRightLowerArm)] =
      turn_about(0.9f + 0.6f * std::cos(phase), Eigen::Vector3f::UnitY());
  pose.R_PB[index_of(Bone::kSpine)] = turn_about(0.2f * std::cos(phase), Eigen::Vector3f::UnitX());
  pose.p_WH_m = Eigen::Vector3f(0.1f * std::sin(phase), 0.935f, 2.0f);
  pose.clock_id = 9;
  pose.capture_time = MonoTime() + Duration::seconds(100.0 + t_s);
  return pose;
}

PoseHistory danced(double seconds, double beat_s = 0.0) {
  PoseHistory history(1024);
  for (int i = 0; i <= static_cast<int>(seconds * kDance_hz); ++i) {
    Pose pose = dance_pose(i / kDance_hz);
    pose.sequence = static_cast<std::uint32_t>(i);
    if (beat_s > 0.0) pose.music_beats = i / kDance_hz / beat_s;
    history.push(pose);
  }
  return history;
}

double newest_s(const PoseHistory& history) {
  return (history.newest().capture_time - MonoTime()).as_seconds() - 100.0;
}

TEST(Continuation, GoesOnWithADanceThatRepeatsAsItWouldHave) {
  const PoseHistory history = danced(9.0);
  Continuation continuation;
  ASSERT_TRUE(continuation.begin(history, average_skeleton()));
  const double lag_s = continuation.lag().as_seconds();
  EXPECT_NEAR(std::remainder(lag_s, kStep_s), 0.0, 0.02) << lag_s;
  for (double since_s = 0.0; since_s < 4.0; since_s += 0.05) {
    Pose out;
    ASSERT_TRUE(continuation.at(Duration::seconds(since_s), out));
    const Pose truth = dance_pose(newest_s(history) + since_s);
    EXPECT_LT(body_error_m(average_skeleton(), out, truth), 0.012) << since_s;
    EXPECT_LT((out.p_WH_m - truth.p_WH_m).norm(), 0.05f) << since_s;
    EXPECT_EQ(out.clock_id, 9u);
    EXPECT_EQ(out.capture_time, history.newest().capture_time + Duration::seconds(since_s));
  }
}

TEST(Continuation, BeginsAtTheNewestPoseAndTheWayItMoves) {
  const PoseHistory history = danced(9.37);
  Continuation continuation;
  continuation.begin(history, average_skeleton());
  Pose out;
  continuation.at(Duration(), out);
  EXPECT_LT(largest_angle_rad(out, history.newest()), 2e-3f);
  EXPECT_LT((out.p_WH_m - history.newest().p_WH_m).norm(), 1e-4f);
}

TEST(Continuation, StandsAndFacesWhereItIsPutAndDancesAsBefore) {
  const PoseHistory history = danced(9.37, 0.4);
  Continuation continuation, there;
  continuation.begin(history, average_skeleton());
  there.begin(history, average_skeleton());
  Pose met = dance_pose(9.5);
  met.R_PB[0] = turn_about(1.2f, Eigen::Vector3f::UnitY());
  met.p_WH_m += Eigen::Vector3f(0.3f, 0.0f, -0.2f);
  const Duration meeting = Duration::ms(350);
  there.put(meeting, met);
  Pose as_before, out;
  there.at(meeting, out);
  EXPECT_LT((out.p_WH_m - met.p_WH_m).head<1>().norm(), 1e-3f);
  EXPECT_NEAR(out.p_WH_m.z(), met.p_WH_m.z(), 1e-3f);
  EXPECT_NEAR(heading_rad(out.R_PB[0]), heading_rad(met.R_PB[0]), 1e-3f);
  Pose before;
  for (double since_s = 0.0; since_s < 9.5; since_s += 0.05) {
    continuation.at(Duration::seconds(since_s), as_before);
    there.at(Duration::seconds(since_s), out);
    EXPECT_LT(body_error_m(average_skeleton(), out, as_before), 2e-3) << since_s;
    if (since_s > 0.0) {
      EXPECT_LT((out.p_WH_m - before.p_WH_m).norm(), 0.06f) << since_s;
    }
    before = out;
  }
}

TEST(Continuation, IsTheSameForTheSameMomentInWhateverOrder) {
  const PoseHistory history = danced(8.0);
  Continuation continuation;
  continuation.begin(history, average_skeleton());
  Pose first, again, other;
  continuation.at(Duration::ms(1234), first);
  for (const int ms : {9000, 10, 5000, 0, -20}) continuation.at(Duration::ms(ms), other);
  continuation.at(Duration::ms(1234), again);
  for (std::size_t b = 0; b < kBoneCount; ++b)
    EXPECT_EQ(first.R_PB[b].coeffs(), again.R_PB[b].coeffs());
}

TEST(Continuation, LoopsOnWholeBarsWhereThereIsMusic) {
  const PoseHistory tagged = danced(10.0, 0.4);  // a step of four beats
  Continuation continuation;
  continuation.begin(tagged, average_skeleton());
  EXPECT_NEAR(std::remainder(continuation.loop().as_seconds(), 1.6), 0.0, 1e-6);
  EXPECT_GT(continuation.loop(), Duration::s(1));
  const PoseHistory bare = danced(10.0);
  continuation.begin(bare, average_skeleton());
  EXPECT_EQ(continuation.loop(), Duration());
  continuation.begin(bare, average_skeleton(), Duration::ms(400));
  EXPECT_GT(continuation.loop(), Duration::s(1)) << "told by the music of the house";
}

TEST(Continuation, HasNoPopAnywhere) {
  const PoseHistory history = danced(9.0, 0.37);  // music that the step does not fit
  Continuation continuation;
  continuation.begin(history, average_skeleton());
  std::vector<Pose> shown, real;
  for (int i = 0; i < 600; ++i) {
    real.push_back(dance_pose(i / kDance_hz));
    Pose out;
    continuation.at(Duration::seconds(i / kDance_hz), out);
    shown.push_back(out);
  }
  const JointTrack track(average_skeleton(), shown, kDance_hz);
  const JointTrack truth(average_skeleton(), real, kDance_hz);
  EXPECT_LT(peak_speed_m_s(track, Places::kWorld, 0, 600),
            2.0 * peak_speed_m_s(truth, Places::kWorld, 0, 600));
  EXPECT_LT(track.bone_length_error_m, 1e-4);
}

TEST(Continuation, CalmsDownToStandingOnTheFloor) {
  const PoseHistory history = danced(9.0);
  Continuation continuation;
  continuation.begin(history, average_skeleton());
  std::vector<Pose> shown;
  for (int i = 0; i < 60; ++i) {
    Pose out;
    continuation.at(Continuation::kCalmFrom + Duration::seconds(i / kDance_hz), out);
    shown.push_back(out);
  }
  const JointTrack track(average_skeleton(), shown, kDance_hz);
  EXPECT_LT(activity_m_s(track, Places::kWorld), 1e-3);
  BodyFrames frames;
  forward_kinematics(average_skeleton(), dance_pose(0.0), frames);
  EXPECT_NEAR(track.world[30][index_of(Bone::kLeftToes)].y(), frames.position(Bone::kLeftToes).y(),
              0.01f);
}

TEST(Continuation, KeepsADancerWhoTravelsOnTheStage) {
  PoseHistory history(1024);
  for (int i = 0; i < 600; ++i) {
    Pose pose = dance_pose(i / kDance_hz);
    pose.p_WH_m.x() = static_cast<float>(1.5 * i / kDance_hz);
    history.push(pose);
  }
  Continuation continuation;
  continuation.begin(history, average_skeleton());
  float furthest_m = 0.0f;
  for (int i = 0; i < 700; ++i) {
    Pose out;
    continuation.at(Duration::seconds(i / kDance_hz), out);
    furthest_m = std::max(furthest_m, (out.p_WH_m - history.newest().p_WH_m).norm());
  }
  EXPECT_GT(furthest_m, 0.5f);
  EXPECT_LT(furthest_m, 1.35f);
}

TEST(Continuation, OfAShortHistoryStandsAtEase) {
  PoseHistory history(64);
  Continuation continuation;
  EXPECT_FALSE(continuation.begin(history, average_skeleton()));
  Pose out;
  EXPECT_FALSE(continuation.at(Duration::ms(100), out));
  history.push(dance_pose(0.0));
  ASSERT_TRUE(continuation.begin(history, average_skeleton()));
  EXPECT_EQ(continuation.lag(), Duration());
  for (const int ms : {0, 500, 3000, 7000, 20'000}) {
    ASSERT_TRUE(continuation.at(Duration::ms(ms), out));
    EXPECT_TRUE(is_valid(out));
    EXPECT_LT((out.p_WH_m - dance_pose(0.0).p_WH_m).norm(), 0.1f);
  }
}

TEST(Continuation, DoesNotShowAgainWhatASensorBroke) {
  // In the middle of the only step that fits, the body is thrown about for three frames.
  PoseHistory history(1024);
  for (int i = 0; i < 300; ++i) {
    Pose pose = dance_pose(i / kDance_hz);
    if (i >= 230 && i < 233) pose.R_PB[0] = turn_about(2.5f, Eigen::Vector3f::UnitX());
    history.push(pose);
  }
  Continuation continuation;
  continuation.begin(history, average_skeleton());
  for (int i = 0; i < 240; ++i) {
    Pose out;
    continuation.at(Duration::seconds(i / kDance_hz), out);
    EXPECT_GT((out.R_PB[0] * Eigen::Vector3f::UnitY()).y(), 0.5f) << i;
  }
}

TEST(Continuation, StaysABodyWhateverTheHistory) {
  Random random(6);
  PoseHistory history(256);
  Continuation continuation;
  MonoTime t = MonoTime() + Duration::s(50);
  for (int round = 0; round < 60; ++round) {
    for (int i = 0; i < 40; ++i) {
      Pose pose = random_pose(random);
      t += i % 17 ? Duration::ms(1 + static_cast<std::int64_t>(random.uniform(0.0, 60.0)))
                  : Duration::s(static_cast<std::int64_t>(random.uniform(0.0, 400.0)));
      pose.capture_time = t;
      if (i % 5 == 0) pose.music_beats = random.uniform(-1e6, 1e6);
      history.push(pose);
    }
    continuation.begin(history, average_skeleton(), Duration::ms(round * 37 - 100));
    for (int ms = -1000; ms < 12'000; ms += 173) {
      Pose out;
      ASSERT_TRUE(continuation.at(Duration::ms(ms), out));
      ASSERT_TRUE(is_valid(out));
    }
    Pose out;
    ASSERT_TRUE(continuation.at(Duration::s(4'000'000), out));
    ASSERT_TRUE(is_valid(out));
  }
}

TEST(Continuation, AllocatesNothing) {
  const PoseHistory history = danced(9.0, 0.4);
  Continuation continuation;
  const Skeleton skeleton = average_skeleton();
  const AllocationGuard guard;
  continuation.begin(history, skeleton);
  for (int i = 0; i < 300; ++i) {
    Pose out;
    continuation.at(Duration::ms(33 * i), out);
  }
  EXPECT_EQ(guard.allocations(), 0u);
}

TEST(Continuation, IsHandedOverToWithoutAStep) {
  EXPECT_EQ(Continuation::share_at(Continuation::kPredictedUntil), 0.0f);
  EXPECT_EQ(Continuation::share_at(Continuation::kContinuedFrom), 1.0f);
  EXPECT_EQ(Continuation::share_at(Duration::s(9)), 1.0f);
  float before = 0.0f;
  for (int ms = 190; ms < 700; ++ms) {
    const float share = Continuation::share_at(Duration::ms(ms));
    EXPECT_GE(share, before);
    EXPECT_LT(share - before, 0.011f);
    before = share;
  }
}

}  // namespace
}  // namespace dance
