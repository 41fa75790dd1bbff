#include "transformers/tempo/period.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/base/random.h"
#include "producers/salsa/salsa_dancer.h"
#include "tests/allocation_guard.h"

namespace dance {
namespace {

constexpr double kNever = 1e9;

MonoTime moment_at(double s) {
  return MonoTime::from_ns(static_cast<std::int64_t>((s + 1.0) * 1e9));
}

struct Salsa {
  explicit Salsa(double tempo_bpm, SalsaRole role = SalsaRole::kLead)
      : dancer([&] {
          SalsaStyle style;
          style.tempo_bpm = tempo_bpm;
          style.role = role;
          style.seed = 5;
          return SalsaDancer(style);
        }()) {}
  Pose at(double s, bool with_music) {
    Pose pose;
    dancer.dance_at(Duration::seconds(s), pose);
    pose.capture_time = moment_at(s);
    pose.clock_id = 1;
    if (!with_music) pose.music_beats = kNoMusic;
    return pose;
  }
  double beats(double s) const { return dancer.music_beats_at(Duration::seconds(s)); }
  SalsaDancer dancer;
};

// Root mean square of what is left when the mean is taken away, where the coherence allows to trust
// it.
struct PhaseError {
  double rms_beats = 0.0;
  double trusted = 0.0;
};
PhaseError phase_error(Period& period, Salsa& salsa, double hz, bool with_music) {
  std::vector<double> errors;
  int asked = 0;
  for (int i = 0; i < static_cast<int>(40.0 * hz); ++i) {
    const double s = i / hz;
    const Pose pose = salsa.at(s, with_music);
    period.observe(pose, pose.capture_time);
    if (s < 15.0) continue;
    ++asked;
    if (period.is_known() && period.coherence() > 0.5f)
      errors.push_back(period.beats(pose.capture_time) - salsa.beats(s));
  }
  double mean = 0.0, sum = 0.0;
  for (const double e : errors) mean += e / static_cast<double>(errors.size());
  for (const double e : errors) sum += (e - mean) * (e - mean);
  return {std::sqrt(sum / static_cast<double>(errors.size())),
          static_cast<double>(errors.size()) / asked};
}

TEST(Period, FindsTempoAndPhaseOfASalsaWithoutMusicAtAnyRateOfPoses) {
  for (const double bpm : {120.0, 184.0, 205.0}) {
    for (const double hz : {30.0, 60.0, 120.0}) {
      Salsa salsa(bpm, bpm > 200.0 ? SalsaRole::kFollow : SalsaRole::kLead);
      Period period;
      period.set_body(salsa.dancer.skeleton());
      const PhaseError error = phase_error(period, salsa, hz, false);
      EXPECT_NEAR(period.tempo_bpm(), bpm, 0.02 * bpm) << hz;
      EXPECT_FALSE(period.has_music());
      EXPECT_LT(error.rms_beats * 60e3 / bpm, 40.0) << bpm << " BPM at " << hz << " Hz, ms";
      EXPECT_GT(error.trusted, 0.9);
    }
  }
}

TEST(Period, FindsThemThroughASensorsNoise) {
  Salsa salsa(184.0);
  Random random(11);
  Period period;
  for (int i = 0; i < 30 * 40; ++i) {
    Pose pose = salsa.at(i / 30.0, false);
    for (auto& R : pose.R_PB) {
      const auto noise = [&] { return static_cast<float>(random.uniform(-0.03, 0.03)); };
      R = R * Eigen::Quaternionf(1.0f, noise(), noise(), noise()).normalized();
    }
    period.observe(pose, pose.capture_time);
  }
  EXPECT_NEAR(period.tempo_bpm(), 184.0, 4.0);
  EXPECT_GT(period.coherence(), 0.5f);
}

TEST(Period, TellsTheCountOfTheBarByTheStepsAlone) {
  Salsa salsa(184.0);
  Period period;
  period.set_body(salsa.dancer.skeleton());
  int asked = 0, right = 0;
  for (int i = 0; i < 60 * 50; ++i) {
    const double s = i / 60.0;
    const Pose pose = salsa.at(s, false);
    period.observe(pose, pose.capture_time);
    if (s < 20.0 || !period.is_anchored()) continue;
    const double off = period.count(pose.capture_time) - salsa.beats(s);
    ++asked;
    // Two bars of eight counts: the same in each four.
    if (std::abs(off - 4.0 * std::round(off / 4.0)) < 0.3) ++right;
  }
  EXPECT_GT(asked, 1200);
  EXPECT_GT(right, asked * 9 / 10);
}

TEST(Period, CountsAsTheMusicWherePosesCarryItAndSaysWhoIsBehind) {
  Salsa salsa(176.0);
  Period period;
  period.set_body(salsa.dancer.skeleton());
  const auto dance = [&](double from_s, double to_s, double late_beats) {
    for (int i = static_cast<int>(from_s * 60.0); i < static_cast<int>(to_s * 60.0); ++i) {
      const double s = i / 60.0;
      Pose pose = salsa.at(s - late_beats * 60.0 / 176.0, true);
      pose.capture_time = moment_at(s);
      pose.music_beats = salsa.beats(s);
      period.observe(pose, pose.capture_time);
    }
  };
  dance(0.0, 30.0, 0.0);
  EXPECT_TRUE(period.has_music());
  EXPECT_NEAR(period.tempo_bpm(), 176.0, 2.0);
  EXPECT_NEAR(period.beats(moment_at(31.0)), salsa.beats(31.0), 0.2);
  const double usual = period.ahead_beats();
  dance(30.0, 33.0, 0.3);
  EXPECT_NEAR(period.ahead_beats() - usual, -0.3, 0.12);
}

TEST(Period, SeesFeetComeToStandOnTheBeatAndHipsTurnBack) {
  Salsa salsa(184.0);
  Period period;
  period.set_body(salsa.dancer.skeleton());
  std::uint64_t seen = 0;
  int falls = 0, on_beat = 0, to_left = 0, to_right = 0;
  for (int i = 0; i < 60 * 30; ++i) {
    const Pose pose = salsa.at(i / 60.0, false);
    period.observe(pose, pose.capture_time);
    const MotionBeats& beats = period.motion_beats();
    for (; seen < beats.count(); ++seen) {
      const MotionBeat& beat = beats.newest(static_cast<std::size_t>(beats.count() - 1 - seen));
      EXPECT_LE(beat.time, pose.capture_time);
      EXPECT_GT(beat.time, pose.capture_time - Duration::ms(900));
      to_left += beat.kind == MotionBeat::Kind::kSwayToLeft ? 1 : 0;
      to_right += beat.kind == MotionBeat::Kind::kSwayToRight ? 1 : 0;
      if (!beat.is_foot_fall() || beat.strength < 0.8f) continue;
      const double at = salsa.beats((beat.time - moment_at(0.0)).as_seconds());
      ++falls;
      on_beat += std::abs(at - std::round(at)) < 0.15 ? 1 : 0;
    }
  }
  EXPECT_GT(falls, 40);
  EXPECT_GT(on_beat, falls * 3 / 4);
  EXPECT_GT(to_left, 20);
  EXPECT_LE(std::abs(to_left - to_right), 1);
}

TEST(Period, KnowsNothingOfSomebodyWhoStands) {
  Period period;
  for (int i = 0; i < 60 * 20; ++i) {
    Pose pose;
    pose.capture_time = moment_at(i / 60.0);
    period.observe(pose, pose.capture_time);
  }
  EXPECT_FALSE(period.is_known());
  EXPECT_EQ(period.coherence(), 0.0f);
}

TEST(Period, BridgesAPauseAndStartsAnewAfterAJump) {
  Salsa salsa(184.0);
  Period period;
  period.set_body(salsa.dancer.skeleton());
  double late_s = 0.0;
  const auto dance = [&](double from_s, double to_s) {
    for (int i = static_cast<int>(from_s * 60.0); i < static_cast<int>(to_s * 60.0); ++i) {
      Pose pose = salsa.at(i / 60.0, false);
      pose.capture_time += Duration::seconds(late_s);
      period.observe(pose, pose.capture_time);
    }
  };
  dance(0.0, 25.0);
  const double before = period.beats(moment_at(25.0)) - salsa.beats(25.0);
  dance(26.5, 29.0);
  EXPECT_TRUE(period.is_known());
  EXPECT_NEAR(period.beats(moment_at(29.0)) - salsa.beats(29.0), before, 0.35);
  late_s = 3600.0;
  dance(29.0, 30.0);
  EXPECT_FALSE(period.is_known());
  late_s = -10.0;
  dance(30.0, 31.0);
  EXPECT_FALSE(period.is_known());
  dance(31.0, 50.0);
  EXPECT_TRUE(period.is_known());
}

TEST(Period, ExtremeTimesAndMusicDoNoHarm) {
  Period period;
  Random random(3);
  Salsa salsa(150.0);
  std::int64_t ns = 1'000'000'000;
  for (int i = 0; i < 4000; ++i) {
    Pose pose = salsa.at(i / 60.0, true);
    const double kind = random.uniform();
    ns += kind < 0.90 ? 16'666'667 : static_cast<std::int64_t>(random.uniform(-3.0, 3.0) * 1e9);
    pose.capture_time = MonoTime::from_ns(ns);
    if (random.uniform() < 0.02) pose.music_beats = random.uniform(-kNever, kNever);
    if (random.uniform() < 0.02) pose.music_beats = kNoMusic;
    if (random.uniform() < 0.1) pose.presence = 0;
    period.observe(pose, pose.capture_time);
    ASSERT_TRUE(std::isfinite(period.beats(pose.capture_time)));
    ASSERT_TRUE(std::isfinite(period.tempo_bpm()));
    ASSERT_GE(period.coherence(), 0.0f);
    ASSERT_LE(period.coherence(), 1.0f);
  }
}

TEST(Period, AllocatesNothingAsPosesCome) {
  Salsa salsa(184.0);
  std::vector<Pose> poses;
  for (int i = 0; i < 60 * 10; ++i) poses.push_back(salsa.at(i / 60.0, i % 300 > 150));
  Period period;
  AllocationGuard guard;
  for (const Pose& pose : poses) period.observe(pose, pose.capture_time);
  EXPECT_EQ(guard.allocations(), 0u);
}

}  // namespace
}  // namespace dance
