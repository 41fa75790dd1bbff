#include "transformers/rhythm/own_beat.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/base/random.h"
#include "producers/salsa/salsa_dancer.h"
#include "tests/allocation_guard.h"

namespace dance {
namespace {

struct Dancing {
  explicit Dancing(double tempo_bpm) {
    SalsaStyle style;
    style.tempo_bpm = tempo_bpm;
    style.seed = 21;
    dancer.emplace(style);
  }
  Pose at(double s) {
    Pose pose;
    dancer->dance_at(Duration::seconds(s), pose);
    pose.capture_time = MonoTime() + Duration::seconds(1.0 + s);
    pose.clock_id = 1;
    pose.music_beats = kNoMusic;
    return pose;
  }
  double beats(double s) const { return dancer->music_beats_at(Duration::seconds(s)); }
  std::optional<SalsaDancer> dancer;
};

TEST(SteadyCount, TakesTheEvenCountFromWordsThatWander) {
  SteadyCount count;
  Random random(4);
  const double counts_per_s = 2.6;
  // A percent off at first, and a fifth of a count.
  count.begin(0.2, counts_per_s * 1.01);
  double wander = 0.0, words = 0.0, told = 0.0;
  for (int i = 1; i <= 600; ++i) {
    wander += -0.03 * wander + random.uniform(-0.045, 0.045);
    const double truth = 0.1 * i * counts_per_s;
    count.go_on(0.1);
    count.hear(truth + wander - count.counts());
    if (i <= 200) continue;
    words += wander * wander / 400.0;
    told += (count.counts() - truth) * (count.counts() - truth) / 400.0;
  }
  EXPECT_NEAR(count.counts_per_s(), counts_per_s, 0.01 * counts_per_s);
  EXPECT_LT(std::sqrt(told), 0.8 * std::sqrt(words));
}

TEST(OwnBeat, TellsTheMusicsBeatToWithinThirtyMillisecondsAndGoesOnEvenly) {
  Dancing salsa(160.0);
  OwnBeat own;
  own.set_body(salsa.dancer->skeleton());
  int known = 0, asked = 0;
  std::optional<double> before;
  for (int i = 0; i < 60 * 60; ++i) {
    const double s = i / 60.0;
    const Pose pose = salsa.at(s);
    const auto told = own.observe(pose, pose.capture_time, 160.0);
    if (s < 15.0) continue;
    ++asked;
    if (told) {
      ++known;
      const double off = *told - salsa.beats(s);
      EXPECT_LT(std::abs(off - 4.0 * std::round(off / 4.0)) * 375.0, 30.0) << s << " s, ms";
      if (before) {
        EXPECT_NEAR(*told - *before, 160.0 / 3600.0, 0.01) << s;
      }
    }
    before = told;
  }
  EXPECT_GT(known, asked * 95 / 100);
}

TEST(OwnBeat, HearsStepsThroughASensorsNoise) {
  Dancing salsa(160.0);
  Random random(11);
  OwnBeat own;
  own.set_body(salsa.dancer->skeleton());
  int known = 0, near = 0;
  for (int i = 0; i < 30 * 60; ++i) {
    Pose pose = salsa.at(i / 30.0);
    for (auto& R : pose.R_PB) {
      const auto noise = [&] { return static_cast<float>(random.uniform(-0.03, 0.03)); };
      R = R * Eigen::Quaternionf(1.0f, noise(), noise(), noise()).normalized();
    }
    const auto told = own.observe(pose, pose.capture_time, 160.0);
    if (i < 30 * 20 || !told) continue;
    ++known;
    const double off = *told - salsa.beats(i / 30.0);
    near += std::abs(off - 4.0 * std::round(off / 4.0)) * 375.0 < 50.0 ? 1 : 0;
  }
  EXPECT_GT(known, 30 * 36);
  EXPECT_GT(near, known * 9 / 10);
}

TEST(OwnBeat, StaysInTimeThroughASecondThatDidNotArrive) {
  Dancing salsa(176.0);
  OwnBeat own;
  own.set_body(salsa.dancer->skeleton());
  const auto dance = [&](double from_s, double to_s) {
    std::optional<double> told;
    for (int i = static_cast<int>(from_s * 60.0); i < static_cast<int>(to_s * 60.0); ++i) {
      const Pose pose = salsa.at(i / 60.0);
      told = own.observe(pose, pose.capture_time, 176.0);
    }
    return told;
  };
  ASSERT_TRUE(dance(0.0, 25.0));
  const auto told = dance(26.0, 26.2);
  ASSERT_TRUE(told);
  const double off = *told - salsa.beats(26.2 - 1.0 / 60.0);
  EXPECT_LT(std::abs(off - 4.0 * std::round(off / 4.0)), 0.15);
}

TEST(OwnBeat, FindsTheBarOfStepsThatKeepAPaceOfTheirOwn) {
  // A tenth from the music: the period hears them first, then the filter looks for them there.
  Dancing salsa(164.0);
  OwnBeat own;
  own.set_body(salsa.dancer->skeleton());
  int known = 0, on_beat = 0, in_bar = 0;
  for (int i = 0; i < 60 * 80; ++i) {
    const double s = i / 60.0;
    const Pose pose = salsa.at(s);
    const auto told = own.observe(pose, pose.capture_time, 148.0);
    if (s < 40.0 || !told) continue;
    ++known;
    const double off = *told - salsa.beats(s);
    on_beat += std::abs(off - std::round(off)) < 0.12 ? 1 : 0;
    in_bar += std::abs(off - 4.0 * std::round(off / 4.0)) < 0.5 ? 1 : 0;
  }
  EXPECT_GT(known, 60 * 36);
  EXPECT_GT(on_beat, known * 9 / 10);
  EXPECT_GT(in_bar, known * 9 / 10);
  // Whom the music has left too far behind is left as they are.
  const Pose pose = salsa.at(80.0);
  EXPECT_FALSE(own.observe(pose, pose.capture_time, 120.0));
}

TEST(OwnBeat, TellsNothingOfWhoStandsOrOfADanceInPieces) {
  Dancing salsa(160.0);
  for (const bool stands : {true, false}) {
    OwnBeat own;
    own.set_body(salsa.dancer->skeleton());
    Random random(5);
    double piece_s = 0.0;
    int told = 0;
    for (int i = 0; i < 60 * 60; ++i) {
      const double s = i / 60.0;
      if (i % 60 == 0) piece_s = stands ? 0.0 : random.uniform(0.0, 300.0);
      Pose pose = salsa.at(stands ? 0.0 : piece_s + (i % 60) / 60.0);
      pose.capture_time = MonoTime() + Duration::seconds(1.0 + s);
      told += own.observe(pose, pose.capture_time, 160.0) ? 1 : 0;
    }
    EXPECT_LT(told, stands ? 1 : 60 * 6);
  }
}

TEST(OwnBeat, AllocatesNothing) {
  Dancing salsa(160.0);
  std::vector<Pose> poses;
  for (int i = 0; i < 60 * 20; ++i) poses.push_back(salsa.at(i / 60.0));
  OwnBeat own;
  AllocationGuard guard;
  for (const Pose& pose : poses) own.observe(pose, pose.capture_time, 160.0);
  EXPECT_EQ(guard.allocations(), 0u);
}

}  // namespace
}  // namespace dance
