#include "transformers/tempo/step_pointer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/base/random.h"
#include "producers/salsa/salsa_dancer.h"
#include "tests/allocation_guard.h"

namespace dance {
namespace {

MonoTime step_time(double s) { return MonoTime() + Duration::seconds(1.0 + s); }

struct SalsaSteps {
  SalsaSteps(double tempo_bpm, SalsaRole role, std::uint64_t seed = 5)
      : dancer([&] {
          SalsaStyle style;
          style.tempo_bpm = tempo_bpm;
          style.role = role;
          style.seed = seed;
          return SalsaDancer(style);
        }()) {
    channels.set_body(dancer.skeleton());
  }
  const MotionFrame& at(double s) {
    Pose pose;
    dancer.dance_at(Duration::seconds(s), pose);
    pose.capture_time = step_time(s);
    return channels.take(pose);
  }
  double beats(MonoTime t) const { return dancer.music_beats_at(t - step_time(0.0)); }
  SalsaDancer dancer;
  MotionChannels channels;
};

double in_bar(double counts) { return counts - 4.0 * std::round(counts / 4.0); }

TEST(StepPattern, HasTheOtherFootFourCountsOn) {
  const StepPattern& steps = salsa_steps();
  for (double phase = 0.0; phase < 1.0; phase += 0.07) {
    EXPECT_NEAR(steps.value(StepPattern::kLeftFoot, phase),
                steps.value(StepPattern::kRightFoot, phase + 0.5), 1e-5);
    EXPECT_NEAR(steps.value(StepPattern::kSway, phase),
                -steps.value(StepPattern::kSway, phase + 0.5), 1e-5);
    EXPECT_NEAR(steps.value(StepPattern::kBounce, phase),
                steps.value(StepPattern::kBounce, phase + 0.5), 1e-5);
  }
}

TEST(StepPattern, IsMirroredAndBroughtForward) {
  StepPattern steps;
  steps.wave[StepPattern::kLeftFoot][0] = 2.0f;
  steps.wave[StepPattern::kLeftFoot][1] = 1.0f;
  steps.wave[StepPattern::kSway][1] = 1.0f;
  steps.wave[StepPattern::kBounce][0] = 1.0f;
  steps.mirror();
  EXPECT_NEAR(steps.value(StepPattern::kLeftFoot, 0.0), 1.5f, 1e-6);
  EXPECT_NEAR(steps.value(StepPattern::kRightFoot, 0.5), 1.5f, 1e-6);
  EXPECT_EQ(steps.wave[StepPattern::kSway][1], 0.0f);
  EXPECT_EQ(steps.wave[StepPattern::kBounce][0], 0.0f);
  StepPattern sooner = salsa_steps();
  sooner.bring_forward(1.0);
  for (double phase = 0.0; phase < 1.0; phase += 0.13)
    EXPECT_NEAR(sooner.value(StepPattern::kSway, phase),
                salsa_steps().value(StepPattern::kSway, phase + 0.125), 1e-5);
}

std::vector<StepSigns::Slot> signs_of(double hz, double from_s, double to_s, StepSigns& signs,
                                      SalsaSteps& salsa) {
  std::vector<StepSigns::Slot> slots;
  for (int i = static_cast<int>(from_s * hz); i < static_cast<int>(to_s * hz); ++i) {
    const std::size_t count = signs.add(salsa.at(i / hz));
    for (std::size_t k = 0; k < count; ++k) slots.push_back(signs.slot(k));
  }
  return slots;
}

TEST(StepSigns, AreTheSameAtAnyRateOfPoses) {
  const auto at = [](double hz) {
    SalsaSteps salsa(176.0, SalsaRole::kLead);
    StepSigns signs;
    return signs_of(hz, 0.0, 20.0, signs, salsa);
  };
  const auto slow = at(30.0), fast = at(120.0);
  ASSERT_GE(slow.size(), 195u);
  for (std::size_t i = 50; i < 195; ++i) {
    EXPECT_EQ(slow[i].middle, fast[i].middle);
    for (std::size_t s = 0; s < StepPattern::kSigns; ++s)
      EXPECT_NEAR(slow[i].sign[s], fast[i].sign[s], 0.35) << i << ' ' << s;
  }
}

TEST(StepSigns, SayWhatNobodySawAndBeginAnewAfterALongPause) {
  SalsaSteps salsa(176.0, SalsaRole::kLead);
  StepSigns signs;
  EXPECT_GE(signs_of(60.0, 0.0, 5.0, signs, salsa).size(), 49u);
  EXPECT_FALSE(signs.has_begun_anew());
  // A second is missing: ten slots go by unseen.
  const std::size_t count = signs.add(salsa.at(6.0));
  EXPECT_GE(count, 9u);
  std::size_t unseen = 0;
  for (std::size_t i = 0; i < count; ++i) unseen += signs.slot(i).is_seen ? 0 : 1;
  EXPECT_GE(unseen, count - 1);
  EXPECT_EQ(signs.add(salsa.at(60.0)), 0u);
  EXPECT_TRUE(signs.has_begun_anew());
  EXPECT_EQ(signs.add(salsa.at(2.0)), 0u);
  EXPECT_TRUE(signs.has_begun_anew());
}

struct Word {
  double sure = 0.0, mean_beats = 0.0, sd_beats = 0.0, furthest_beats = 0.0;
};
// Of a minute of salsa beside a music, from the fifteenth second on.
Word word_on(StepPointer& pointer, SalsaSteps& salsa, double music_bpm) {
  StepSigns signs;
  Word word;
  std::vector<double> off;
  int asked = 0;
  for (int i = 0; i < 60 * 60; ++i) {
    const std::size_t count = signs.add(salsa.at(i / 60.0));
    for (std::size_t k = 0; k < count; ++k) {
      pointer.add(signs.slot(k), music_bpm);
      if (i < 15 * 60) continue;
      ++asked;
      const MonoTime t = signs.slot(k).middle;
      if (pointer.sureness() > 0.9f) off.push_back(in_bar(pointer.counts(t) - salsa.beats(t)));
    }
  }
  for (const double o : off) {
    word.mean_beats += o / static_cast<double>(off.size());
    word.furthest_beats = std::max(word.furthest_beats, std::abs(o));
  }
  for (const double o : off)
    word.sd_beats +=
        (o - word.mean_beats) * (o - word.mean_beats) / static_cast<double>(off.size());
  word.sd_beats = std::sqrt(word.sd_beats);
  word.sure = static_cast<double>(off.size()) / asked;
  return word;
}

// These dancers were not among those whom the steps were learnt from; where their beat is was told
// by four others of them.
TEST(StepPointer, FindsThePlaceInTheBarOfBothPartnersBesideTheirMusic) {
  for (const double bpm : {130.0, 176.0, 205.0})
    for (const SalsaRole role : {SalsaRole::kLead, SalsaRole::kFollow}) {
      SalsaSteps salsa(bpm, role, 11);
      StepPointer pointer;
      const Word word = word_on(pointer, salsa, bpm);
      EXPECT_GT(word.sure, 0.85) << bpm;
      EXPECT_LT(std::abs(word.mean_beats) * 60e3 / bpm, 20.0) << bpm << ", ms";
      EXPECT_LT(word.sd_beats * 60e3 / bpm, 20.0) << bpm << ", ms";
      EXPECT_LT(word.furthest_beats, 0.5) << bpm;
      EXPECT_NEAR(pointer.tempo_bpm(), bpm, 0.02 * bpm);
      EXPECT_EQ(pointer.counts_per_beat(), 1.0);
    }
}

TEST(StepPointer, DoesNotLagBehindAMusicThatIsAPercentOff) {
  for (const double faster : {0.98, 1.02}) {
    SalsaSteps salsa(170.0, SalsaRole::kLead, 3);
    StepPointer pointer;
    const Word word = word_on(pointer, salsa, 170.0 * faster);
    EXPECT_GT(word.sure, 0.95) << faster;
    EXPECT_LT(std::abs(word.mean_beats) * 60e3 / 170.0, 25.0) << faster << ", ms";
  }
}

TEST(StepPointer, CountsTwiceAsFastAsASlowMusic) {
  SalsaSteps salsa(184.0, SalsaRole::kFollow, 7);
  StepPointer pointer;
  const Word word = word_on(pointer, salsa, 92.0);
  EXPECT_GT(word.sure, 0.9);
  EXPECT_EQ(pointer.counts_per_beat(), 2.0);
  EXPECT_LT(word.furthest_beats, 0.5);
}

TEST(StepPointer, IsNotSureOfAnotherTempoOrOfNoise) {
  SalsaSteps salsa(130.0, SalsaRole::kLead);
  StepPointer pointer;
  EXPECT_LT(word_on(pointer, salsa, 170.0).sure, 0.05);
  pointer.forget();
  Random random(7);
  int sure = 0;
  for (int i = 0; i < 1200; ++i) {
    StepSigns::Slot slot;
    slot.middle = step_time(0.1 * i);
    slot.is_seen = true;
    for (float& sign : slot.sign) sign = static_cast<float>(random.uniform(-1.7, 1.7));
    pointer.add(slot, 170.0);
    sure += pointer.sureness() > 0.9f ? 1 : 0;
  }
  EXPECT_LT(sure, 24);
}

TEST(StepPointer, StaysFiniteWhateverComesAndAllocatesNothing) {
  StepPointer pointer;
  Random random(9);
  AllocationGuard guard;
  for (int i = 0; i < 4000; ++i) {
    StepSigns::Slot slot;
    slot.middle = step_time(0.1 * i);
    slot.is_seen = i % 7 != 0;
    for (float& sign : slot.sign) sign = static_cast<float>(random.uniform(-3.0, 3.0));
    // Musics nobody dances to are borne, too.
    pointer.add(slot, i % 500 < 400 ? 80.0 + i % 160 : random.uniform(1.0, 900.0));
    ASSERT_TRUE(std::isfinite(pointer.counts(slot.middle)));
    ASSERT_TRUE(std::isfinite(pointer.tempo_bpm()));
    ASSERT_GE(pointer.sureness(), 0.0f);
    ASSERT_LE(pointer.sureness(), 1.0f);
  }
  EXPECT_EQ(guard.allocations(), 0u);
}

}  // namespace
}  // namespace dance
