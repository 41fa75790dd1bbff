#include "transformers/conceal/concealment.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/pose/interpolate.h"
#include "testing/motion/motion_measures.h"
#include "tests/allocation_guard.h"
#include "tests/core/pose/random_pose.h"
#include "tests/transformers/flows.h"

namespace dance {
namespace {

MonoTime lapse_time(double seconds) { return MonoTime() + Duration::seconds(seconds); }

Pose swaying(double t_s) {
  Pose pose;
  const auto phase = static_cast<float>(2.0 * M_PI * t_s / 1.5);
  pose.R_PB[index_of(Bone::kLeftUpperArm)] =
      Eigen::Quaternionf(Eigen::AngleAxisf(0.8f * std::sin(phase), Eigen::Vector3f::UnitZ()));
  pose.R_PB[index_of(Bone::kSpine)] =
      Eigen::Quaternionf(Eigen::AngleAxisf(0.2f * std::cos(phase), Eigen::Vector3f::UnitX()));
  pose.p_WH_m.x() = 0.1f * std::sin(phase);
  pose.capture_time = lapse_time(t_s);
  pose.clock_id = 3;
  return pose;
}

constexpr double kDelay_s = 0.05;

// Dances from 1 s to 20 s at 60 Hz over a line of 50 ms, silent between two moments; what is shown
// from `from_s` on.
std::vector<Pose> show(Flow& flow, double silent_from_s, double silent_to_s, double from_s,
                       double to_s) {
  std::vector<Pose> shown;
  for (int i = 60; i / 60.0 < to_s; ++i) {
    const double t_s = i / 60.0;
    if (t_s < silent_from_s || t_s >= silent_to_s)
      flow.observe(swaying(t_s), lapse_time(t_s + kDelay_s));
    Pose out;
    EXPECT_TRUE(flow.sample(lapse_time(t_s + kDelay_s + 0.001), out));
    EXPECT_TRUE(is_valid(out));
    if (t_s >= from_s) shown.push_back(out);
  }
  return shown;
}

TEST(Bridge, ShowsWhatItWouldWithoutWhilePosesCome) {
  Flow bare = *Flow::make({"hold 20ms"}), bridged = *Flow::make({"hold 20ms", "bridge"});
  const auto expected = show(bare, 99.0, 99.0, 2.0, 8.0);
  const auto shown = show(bridged, 99.0, 99.0, 2.0, 8.0);
  ASSERT_EQ(shown.size(), expected.size());
  for (std::size_t i = 0; i < shown.size(); ++i) {
    EXPECT_EQ(shown[i].p_WH_m, expected[i].p_WH_m);
    EXPECT_EQ(shown[i].capture_time, expected[i].capture_time);
    for (std::size_t b = 0; b < kBoneCount; ++b)
      EXPECT_EQ(shown[i].R_PB[b].coeffs(), expected[i].R_PB[b].coeffs());
  }
}

TEST(Bridge, KeepsADancerDancingThroughALapseAndComesBackWithoutAJump) {
  Flow flow = *Flow::make({"hold 0ms", "bridge"});
  const auto shown = show(flow, 12.0, 14.0, 11.0, 16.0);
  std::vector<Pose> danced;
  for (std::size_t i = 0; i < shown.size(); ++i)
    danced.push_back(swaying(11.0 + static_cast<double>(i) / 60.0));
  const JointTrack track(average_skeleton(), shown, 60.0), truth(average_skeleton(), danced, 60.0);
  const double alive =
      activity_m_s(track, Places::kWorld, 90, 180) / activity_m_s(truth, Places::kWorld, 90, 180);
  EXPECT_GT(alive, 0.8);
  EXPECT_LT(alive, 1.25);
  EXPECT_LT(body_error_m(track, truth, 90, 180), 0.02) << "the dance repeats";
  EXPECT_LT(peak_speed_m_s(track, Places::kWorld, 0, shown.size()),
            2.0 * peak_speed_m_s(truth, Places::kWorld, 0, shown.size()));
  EXPECT_LT(world_error_m(track, truth, 270, 300), 0.002) << "as danced again";
}

// Says of every moment after the newest pose that the dancer stands.
class Standing : public Extrapolator {
 public:
  void observe(const Pose& pose, MonoTime) override { newest_ = pose; }
  void predict(MonoTime, Pose& out) const override { out = newest_; }

 private:
  Pose newest_;
};

TEST(Bridge, FadesFromOneWhoStandsToOneWhoSpinsNoFasterThanTheySpun) {
  constexpr float kSpin_rad_s = 4.0f;
  Flow flow = concealed(std::make_unique<Standing>());
  float largest_rad_s = 0.0f;
  Pose before;
  for (int i = 60; i < 720; ++i) {
    const double t_s = i / 60.0;
    Pose pose = swaying(t_s);
    pose.R_PB[0] = Eigen::Quaternionf(
        Eigen::AngleAxisf(kSpin_rad_s * static_cast<float>(t_s), Eigen::Vector3f::UnitY()));
    if (t_s < 10.0) flow.observe(pose, lapse_time(t_s));
    Pose out;
    ASSERT_TRUE(flow.sample(lapse_time(t_s), out));
    if (i > 60)
      largest_rad_s = std::max(largest_rad_s, 60.0f * before.R_PB[0].angularDistance(out.R_PB[0]));
    before = out;
  }
  EXPECT_TRUE(flow.is_continuing());
  EXPECT_LT(largest_rad_s, 1.5f * kSpin_rad_s);
}

TEST(Bridge, DoesNotTakeALongDelayForALapse) {
  Flow flow = *Flow::make({"bridge"});
  for (int i = 60; i < 600; ++i) {
    const double t_s = i / 60.0;
    flow.observe(swaying(t_s), lapse_time(t_s + 0.4));
    Pose out;
    ASSERT_TRUE(flow.sample(lapse_time(t_s + 0.401), out));
    ASSERT_FALSE(flow.is_continuing()) << t_s;
  }
  Pose out;
  flow.sample(lapse_time(10.0 + 0.6), out);
  EXPECT_TRUE(flow.is_continuing());
}

TEST(Bridge, BeginsToMoveWithoutAJumpWhereAPoseStood) {
  Flow flow = *Flow::make({"hold 0ms", "bridge"});
  const auto shown = show(flow, 12.0, 99.0, 11.5, 15.0);
  float largest = 0.0f;
  for (std::size_t i = 1; i < shown.size(); ++i)
    largest = std::max(largest, (shown[i].p_WH_m - shown[i - 1].p_WH_m).norm());
  EXPECT_TRUE(flow.is_continuing());
  EXPECT_LT(largest * 60.0f, 1.2f) << "the hips sway at 0.42 m/s at most";
}

// Knows where the dancer goes: at 0.4 m/s along x.
class Walking : public Extrapolator {
 public:
  static Pose at(MonoTime moment) {
    Pose pose = swaying((moment - MonoTime()).as_seconds());
    pose.p_WH_m.x() = 0.4f * static_cast<float>((moment - lapse_time(10.0)).as_seconds());
    return pose;
  }
  void observe(const Pose&, MonoTime) override {}
  void predict(MonoTime moment, Pose& out) const override { out = at(moment); }
};

TEST(Bridge, FadesByTheDancesTimeHoweverLateTheLineAndTheMomentsAskedFor) {
  // A listener who is a beat and more behind, over a line of 300 ms.
  for (const double late_s : {0.35, 0.8, 1.5}) {
    DancerTimeline timeline(Concealment::kPoses);
    MotionSource::Parts parts;
    parts.extrapolator = std::make_unique<Walking>();
    parts.reach = Duration::s(1);
    parts.concealment = std::make_unique<Concealment>();
    MotionSource source(timeline, std::move(parts));
    for (int i = 60; i <= 600; ++i) {
      const Pose pose = Walking::at(lapse_time(i / 60.0));
      timeline.take(pose, pose.capture_time + Duration::ms(300));
      source.observe();
    }
    Pose out;
    for (double since_s = 0.01; since_s < 0.9; since_s += 1.0 / 60.0) {
      const MonoTime moment = lapse_time(10.0 + since_s);
      source.begin_continuation(moment, moment + Duration::seconds(late_s));
      source.at(moment, out);
      const Pose danced = Walking::at(moment);
      EXPECT_NEAR(out.p_WH_m.x(), danced.p_WH_m.x(), 0.06f) << late_s << " " << since_s;
      const bool is_predicted = (out.R_PB[index_of(Bone::kLeftUpperArm)].coeffs() -
                                 danced.R_PB[index_of(Bone::kLeftUpperArm)].coeffs())
                                    .norm() == 0.0f;
      if (since_s < 0.25) {
        EXPECT_TRUE(is_predicted) << late_s << " " << since_s;
      }
      if (since_s > 0.35) {
        EXPECT_FALSE(is_predicted) << late_s << " " << since_s;
      }
    }
    // What was danced stays what it was.
    EXPECT_EQ(source.at(lapse_time(9.0), out), MotionSource::Kind::kDanced);
    EXPECT_LT(largest_angle_rad(out, Walking::at(lapse_time(9.0))), 1e-3f);
  }
}

TEST(Bridge, StartsAnewWhenTheSourceChangesItsClockOrJumpsBack) {
  Flow bridge = *Flow::make({"bridge"});
  for (int i = 60; i < 300; ++i) bridge.observe(swaying(i / 60.0), lapse_time(i / 60.0));
  Pose out;
  ASSERT_TRUE(bridge.sample(lapse_time(6.0), out));
  EXPECT_TRUE(bridge.is_continuing());
  Pose other = swaying(2.0);
  other.clock_id = 77;
  bridge.observe(other, lapse_time(6.1));
  ASSERT_TRUE(bridge.sample(lapse_time(6.11), out));
  EXPECT_FALSE(bridge.is_continuing());
  EXPECT_LT((out.p_WH_m - other.p_WH_m).norm(), 1e-4f);
  EXPECT_EQ(bridge.counters().restarts, 1u);
}

TEST(Bridge, StaysABodyAndAllocatesNothingWhateverComes) {
  Flow flow = *Flow::make({"hold 20ms", "bridge"});
  Random random(8);
  MonoTime now = lapse_time(50.0);
  const AllocationGuard guard;
  for (int i = 0; i < 3000; ++i) {
    Pose pose = i % 3 ? swaying((now - MonoTime()).as_seconds()) : random_pose(random);
    pose.capture_time =
        now - Duration::ms(static_cast<std::int64_t>(random.uniform(-300.0, 300.0)));
    pose.clock_id = i % 500 == 499 ? 5 : 3;
    if (random.uniform() < 0.7) flow.observe(pose, now);
    Pose out;
    if (flow.sample(now, out)) {
      ASSERT_TRUE(is_valid(out)) << i;
    }
    now += Duration::ms(static_cast<std::int64_t>(random.uniform(-20.0, i % 50 ? 60.0 : 6000.0)));
  }
  EXPECT_EQ(guard.allocations(), 0u);
}

TEST(Bridge, TakesItsBlendAndRefusesNonsense) {
  EXPECT_TRUE(Flow::make({"hold", "bridge blend=80ms"}));
  EXPECT_FALSE(Flow::make({"bridge blend=80"}));
  EXPECT_FALSE(Flow::make({"bridge blind=80ms"}));
  EXPECT_EQ(Flow::make({"hold", "bridge"})->longest_silence(), Continuation::kLongest);
  EXPECT_EQ(Flow::make({"hold"})->longest_silence(), Duration());
}

}  // namespace
}  // namespace dance
