// Each figure against a stream in which it is known.
#include "viewer/instruments/guest_meter.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/pose/kinematics.h"
#include "tests/allocation_guard.h"
#include "tests/viewer/instruments/synthetic_line.h"

namespace dance {
namespace {

constexpr double kPeriod_ms = 10.0;
constexpr double kLine_ms = kPublished_ms + kSent_ms + kServer_ms + kReceived_ms;
const BeatClock kNoBeats;

// A stage that predicts `ahead_ms` beyond the newest pose and is `wrong_m` off with the hips.
struct Stage {
  double ahead_ms = 0.0;
  double wrong_m = 0.0;
  double wrong_rad = 0.0;
};

// Plays `poses` poses of 100 a second through the meter; `skips(i)` are lost, `jitter(i)` ms later.
template <class Skips, class Jitter>
GuestStats play(GuestMeter& meter, int poses, const Stage& stage, Skips skips, Jitter jitter) {
  MonoTime now;
  for (int i = 0; i < poses; ++i) {
    const MonoTime captured = at_ms(5000.0 + kPeriod_ms * i);
    if (skips(i)) continue;
    const Pose pose = arrived_at_house(captured, static_cast<std::uint32_t>(i), jitter(i));
    const MonoTime received = pose.stamped(Hop::kLinkReceived);
    meter.on_arrived(pose, received + Duration::us(500), kNoBeats);
    Pose staged = dance_at(captured + Duration::seconds(1e-3 * stage.ahead_ms),
                           static_cast<std::uint32_t>(i));
    staged.p_WH_m.x() += static_cast<float>(stage.wrong_m);
    Eigen::Quaternionf& arm = staged.R_PB[index_of(Bone::kLeftUpperArm)];
    arm = arm * Eigen::AngleAxisf(static_cast<float>(stage.wrong_rad), Eigen::Vector3f::UnitZ());
    staged.stamp(Hop::kStageTaken, received + Duration::ms(4));
    staged.stamp(Hop::kStaged, received + Duration::ms(5));
    const MonoTime heard = received + Duration::ms(6);
    meter.on_staged(staged, heard, kNoBeats);
    now = received + Duration::ms(9);
    meter.on_shown(shown_at(staged, heard, now));
    if (meter.is_due(now) && i + 1 < poses) meter.end_second(now);
  }
  return meter.end_second(now);
}

const auto kNever = [](int) { return false; };
const auto kSteady = [](int) { return 0.0; };

TEST(GuestMeter, SaysWhereEachMillisecondWent) {
  GuestMeter meter(kHouseClock);
  const GuestStats stats = play(meter, 250, {}, kNever, kSteady);
  const GapFigures expected{1.0f, 1.0f, 20.0f, 30.0f, 4.0f, 1.0f, 1.0f, 3.0f};
  for (std::size_t gap = 0; gap < kGapCount; ++gap) {
    EXPECT_NEAR(stats.gap_p50_ms[gap], expected[gap], 0.01f) << gap;
    EXPECT_NEAR(stats.gap_p99_ms[gap], expected[gap], 0.01f) << gap;
  }
  EXPECT_NEAR(stats.newest_p50_ms, kLine_ms + 9.0, 0.01);
  EXPECT_NEAR(stats.age_p50_ms, kLine_ms + 9.0, 0.01);
  EXPECT_NEAR(stats.jitter_ms, 0.0f, 1e-3f);
  EXPECT_EQ(stats.loss_percent, 0.0f);
  EXPECT_EQ(stats.received, 250);
  EXPECT_EQ(stats.superseded, 0);
  EXPECT_TRUE(std::isnan(stats.error_mean_mm)) << "nothing was predicted";
  EXPECT_TRUE(std::isnan(stats.beat_ms)) << "there is no music";
  EXPECT_TRUE(std::isnan(stats.bytes_per_second)) << "no link has told";
}

TEST(GuestMeter, TellsTheAgeOfWhatIsShownFromThatOfTheNewestPose) {
  GuestMeter meter(kHouseClock);
  const GuestStats stats = play(meter, 250, {61.0}, kNever, kSteady);
  EXPECT_NEAR(stats.newest_p50_ms, kLine_ms + 9.0, 0.01);
  EXPECT_NEAR(stats.age_p50_ms, kLine_ms + 9.0 - 61.0, 0.01);
  EXPECT_NEAR(stats.horizon_p50_ms, 61.0, 0.01);
  EXPECT_NEAR(stats.horizon_p99_ms, 61.0, 0.01);
}

TEST(GuestMeter, MeasuresRatesInTheSecondThatEnds) {
  GuestMeter meter(kHouseClock);
  const GuestStats stats = play(
      meter, 250, {}, [](int i) { return i % 2 == 1; }, kSteady);
  EXPECT_NEAR(stats.arrival_hz, 50.0f, 1.5f);
  EXPECT_NEAR(stats.stage_hz, 50.0f, 1.5f);
  EXPECT_NEAR(stats.shown_hz, 50.0f, 1.5f);
}

TEST(GuestMeter, CountsLossAndWhatComesLate) {
  GuestMeter meter(kHouseClock);
  const GuestStats stats = play(
      meter, 250, {}, [](int i) { return i > 0 && i % 10 == 0; }, kSteady);
  EXPECT_NEAR(stats.loss_percent, 10.0f, 2.0f);
  EXPECT_EQ(stats.lost, 24);
  EXPECT_EQ(stats.received, 226);
  meter.on_arrived(arrived_at_house(at_ms(7400.0), 240), at_ms(7600.0), kNoBeats);
  EXPECT_EQ(meter.end_second(at_ms(8600.0)).late, 1);
}

TEST(GuestMeter, APoseThatComesTwiceIsNeitherLateNorFindsOneThatIsLost) {
  GuestMeter meter(kHouseClock);
  for (int i = 0; i < 100; ++i) {
    if (i % 10 == 5) continue;
    const MonoTime captured = at_ms(5000.0 + kPeriod_ms * i);
    const Pose pose = arrived_at_house(captured, static_cast<std::uint32_t>(i), 0.0);
    for (int time = 0; time < 2; ++time)
      meter.on_arrived(pose, captured + Duration::ms(60), kNoBeats);
  }
  const GuestStats stats = meter.end_second(at_ms(6060.0));
  EXPECT_EQ(stats.received, 90);
  EXPECT_EQ(stats.lost, 10);
  EXPECT_EQ(stats.late, 0);
  EXPECT_NEAR(stats.loss_percent, 10.0f, 0.01f);
}

TEST(GuestMeter, CountsPosesOfASenderThatDoesNotNumberThem) {
  GuestMeter meter(kHouseClock);
  for (int i = 0; i < 100; ++i) {
    const MonoTime captured = at_ms(5000.0 + kPeriod_ms * i);
    meter.on_arrived(arrived_at_house(captured, 0, 0.0), captured + Duration::ms(60), kNoBeats);
  }
  const GuestStats stats = meter.end_second(at_ms(6060.0));
  EXPECT_EQ(stats.received, 100);
  EXPECT_EQ(stats.late, 0);
}

TEST(GuestMeter, EstimatesJitterAsRfc3550Does) {
  GuestMeter meter(kHouseClock);
  // Alternately on time and 6 ms later: every difference of transits is 6 ms.
  const GuestStats stats =
      play(meter, 400, {}, kNever, [](int i) { return i % 2 == 0 ? 0.0 : 6.0; });
  EXPECT_NEAR(stats.jitter_ms, 6.0f, 0.05f);
  EXPECT_NEAR(stats.gap_p99_ms[static_cast<std::size_t>(Hop::kLinkReceived)], 36.0f, 0.01f);
  EXPECT_NEAR(stats.gap_p50_ms[static_cast<std::size_t>(Hop::kServer)], 20.0f, 0.01f);
}

TEST(GuestMeter, FindsNoErrorInAPredictionThatIsRight) {
  GuestMeter meter(kHouseClock);
  const GuestStats stats = play(meter, 250, {75.0}, kNever, kSteady);
  EXPECT_NEAR(stats.error_mean_mm, 0.0f, 0.02f);
  EXPECT_NEAR(stats.error_p95_mm, 0.0f, 0.05f);
  EXPECT_NEAR(stats.hips_error_mm, 0.0f, 0.2f);
}

TEST(GuestMeter, MeasuresTheErrorOfPredictionsAgainstWhatCame) {
  const double wrong_rad = 0.2;
  GuestMeter meter(kHouseClock);
  const GuestStats stats = play(meter, 250, {75.0, 0.030, wrong_rad}, kNever, kSteady);
  EXPECT_NEAR(stats.hips_error_mm, 30.0f, 0.2f);
  // The chord of each joint below the shoulder, by hand.
  const Skeleton body = average_skeleton();
  double sum_mm = 0.0;
  float most_mm = 0.0f;
  float reach_m = 0.0f;
  for (const Bone bone : {Bone::kLeftLowerArm, Bone::kLeftHand}) {
    reach_m += body.offset_m[index_of(bone)].norm();
    most_mm = 1e3f * 2.0f * reach_m * std::sin(0.5f * static_cast<float>(wrong_rad));
    sum_mm += static_cast<double>(most_mm);
  }
  EXPECT_NEAR(stats.error_mean_mm, sum_mm / (kBoneCount - 1), 0.02);
  EXPECT_NEAR(stats.error_p95_mm, most_mm, most_mm * 0.6f) << "two of 21 joints are wrong";
}

TEST(PredictionCheck, LeavesMomentsOutThatLieInAGap) {
  const auto check_across = [](double gap_ms) {
    PredictionCheck check;
    check.on_arrived(dance_at(at_ms(5000.0), 0));
    Pose shown = dance_at(at_ms(5100.0), 0);
    shown.p_WH_m.x() += 0.05f;
    check.on_staged(shown);
    check.on_arrived(dance_at(at_ms(5000.0 + gap_ms), 1));
    return check.take().hips_mm;
  };
  EXPECT_NEAR(check_across(150.0), 50.0f, 0.2f);
  EXPECT_TRUE(std::isnan(check_across(250.0)));
  EXPECT_TRUE(std::isnan(check_across(90.0))) << "that moment has not come";
}

TEST(PredictionCheck, KeepsWhatHasNotComeYetUntilItHas) {
  PredictionCheck check;
  check.on_arrived(dance_at(at_ms(5000.0), 0));
  for (int ahead_ms = 5; ahead_ms <= 95; ahead_ms += 10) {
    Pose shown = dance_at(at_ms(5000.0 + ahead_ms), 0);
    shown.p_WH_m.y() += 1e-3f * static_cast<float>(ahead_ms);
    check.on_staged(shown);
  }
  check.on_arrived(dance_at(at_ms(5050.0), 1));
  EXPECT_NEAR(check.take().hips_mm, 25.0f, 0.2f) << "5, 15 … 45";
  check.on_arrived(dance_at(at_ms(5100.0), 2));
  EXPECT_NEAR(check.take().hips_mm, 75.0f, 0.2f) << "55, 65 … 95";
}

TEST(GuestMeter, TellsAnOwnDancerThatIsShownFromTheCapture) {
  GuestMeter meter(kHouseClock);
  MonoTime now;
  for (int i = 0; i < 150; ++i) {
    Pose pose = dance_at(at_ms(5000.0 + kPeriod_ms * i), static_cast<std::uint32_t>(i));
    pose.stamp(Hop::kPublished, pose.capture_time + Duration::ms(12));
    const MonoTime heard = pose.capture_time + Duration::ms(13);
    meter.on_arrived(pose, heard, kNoBeats);
    now = heard + Duration::ms(8);
    meter.on_shown(shown_at(pose, heard, now));
    Pose staged = pose;
    staged.stamp(Hop::kStageTaken, heard);
    staged.stamp(Hop::kStaged, heard);
    meter.on_staged(staged, heard + Duration::us(200), kNoBeats);
    if (i == 30) meter.end_second(now);  // by then the meter knows what is shown
  }
  const GuestStats stats = meter.end_second(now);
  EXPECT_NEAR(stats.gap_p50_ms[0], 12.0f, 0.01f);
  EXPECT_TRUE(std::isnan(stats.gap_p50_ms[static_cast<std::size_t>(Hop::kServer)]));
  EXPECT_TRUE(std::isnan(stats.gap_p50_ms[static_cast<std::size_t>(Hop::kStaged)]));
  EXPECT_NEAR(stats.gap_p50_ms[kHeardGap], 1.0f, 0.01f);
  EXPECT_NEAR(stats.gap_p50_ms[kShownGap], 8.0f, 0.01f);
  EXPECT_NEAR(stats.newest_p50_ms, 21.0f, 0.01f);
}

// A house stages own captures before it publishes them: they are heard in that order.
TEST(GuestMeter, TakesNoPoseOfARouteWithoutTransformersForAPrediction) {
  GuestMeter meter(kHouseClock);
  meter.on_flow(FlowSetting());
  MonoTime now;
  for (std::uint32_t i = 0; i < 150; ++i) {
    Pose pose = dance_at(at_ms(5000.0 + kPeriod_ms * i), i);
    pose.stamp(Hop::kPublished, pose.capture_time + Duration::ms(2));
    Pose staged = pose;
    staged.stamp(Hop::kStageTaken, pose.capture_time + Duration::ms(3));
    staged.stamp(Hop::kStaged, pose.capture_time + Duration::ms(3));
    now = pose.capture_time + Duration::ms(4);
    meter.on_staged(staged, now, kNoBeats);
    meter.on_arrived(pose, now, kNoBeats);
  }
  const GuestStats stats = meter.end_second(now);
  EXPECT_NEAR(stats.gap_p50_ms[static_cast<std::size_t>(Hop::kStageTaken)], 1.0f, 0.01f);
  EXPECT_TRUE(std::isnan(stats.error_mean_mm));
  EXPECT_TRUE(std::isnan(stats.horizon_p50_ms));
}

TEST(GuestMeter, CountsPosesThatNoPictureShowed) {
  GuestMeter meter(kHouseClock);
  MonoTime now = at_ms(5000.0);
  for (std::uint32_t i = 0; i < 120; ++i) {
    now = now + Duration::ms(8);
    Pose staged = dance_at(now, i);
    staged.stamp(Hop::kStaged, now);
    meter.on_staged(staged, now, kNoBeats);
    if (i % 3 == 0) meter.on_shown(shown_at(staged, now, now + Duration::ms(2)));
  }
  EXPECT_EQ(meter.end_second(now + Duration::ms(40)).superseded, 39 * 2);
}

TEST(GuestMeter, MeasuresTheBeatAgainstThisHousesMusic) {
  BeatClock music;
  Beat beat;
  beat.playing = true;
  beat.tempo_bpm = 150.0;  // 400 ms a beat
  beat.confidence = 1.0f;
  GuestMeter meter(kHouseClock);
  MonoTime now = at_ms(5000.0);
  for (std::uint32_t i = 0; i < 200; ++i) {
    now = now + Duration::ms(10);
    beat.time = beat.beat_time = now;
    beat.beat = 7.0 + (now - at_ms(5000.0)).as_seconds() * 2.5;
    music.hear(beat);
    Pose staged = dance_at(now, i);
    staged.music_beats = music.position(now) - 0.2;  // danced a fifth of a beat ago
    meter.on_staged(staged, now, music);
  }
  const GuestStats stats = meter.end_second(now);
  EXPECT_NEAR(stats.beat_ms, 80.0f, 0.5f);
  EXPECT_NEAR(stats.beat_share, 0.2f, 0.002f);
}

TEST(GuestMeter, TellsWhatTheTunnelTookFromTheLinksCounts) {
  GuestMeter meter(kHouseClock);
  meter.on_arrived(arrived_at_house(at_ms(5000.0), 0), at_ms(5052.0), kNoBeats);
  GuestTraffic traffic;
  traffic.time = at_ms(5000.0);
  traffic.bytes = 10'000;
  traffic.received = 100;
  meter.on_traffic(traffic);
  traffic.time = at_ms(6000.0);
  traffic.bytes = 13'600;
  traffic.received = 160;
  meter.on_traffic(traffic);
  GuestStats stats = meter.end_second(at_ms(6052.0));
  EXPECT_NEAR(stats.bytes_per_second, 3600.0f, 0.1f);
  EXPECT_NEAR(stats.bytes_per_pose, 60.0f, 0.01f);
  stats = meter.end_second(at_ms(10'000.0));
  EXPECT_TRUE(std::isnan(stats.bytes_per_second)) << "the link has been silent for long";
  traffic.time = at_ms(11'000.0);
  traffic.bytes = 40;  // a link that began anew
  traffic.received = 1;
  meter.on_traffic(traffic);
  EXPECT_TRUE(std::isnan(meter.end_second(at_ms(11'000.0)).bytes_per_second));
}

TEST(GuestMeter, BeginsAnewWhenTimeGoesBack) {
  GuestMeter meter(kHouseClock);
  play(meter, 250, {50.0}, kNever, kSteady);
  const GuestStats again = play(meter, 250, {50.0}, kNever, kSteady);
  EXPECT_NEAR(again.horizon_p50_ms, 50.0f, 0.01f);
  EXPECT_NEAR(again.error_mean_mm, 0.0f, 0.02f);
  EXPECT_LT(again.jitter_ms, 1.0f);
}

TEST(GuestMeter, TimesNothingOfAnotherClock) {
  GuestMeter meter(kHouseClock + 1);
  const GuestStats stats = play(meter, 250, {50.0}, kNever, kSteady);
  for (const float gap : stats.gap_p50_ms) EXPECT_TRUE(std::isnan(gap));
  EXPECT_TRUE(std::isnan(stats.age_p50_ms));
  EXPECT_NEAR(stats.arrival_hz, 100.0f, 2.0f);
}

TEST(GuestMeter, AllocatesNothing) {
  auto meter = std::make_unique<GuestMeter>(kHouseClock);
  const AllocationGuard guard;
  play(*meter, 250, {50.0, 0.01, 0.1}, kNever, kSteady);
  EXPECT_EQ(guard.allocations(), 0u);
}

}  // namespace
}  // namespace dance
