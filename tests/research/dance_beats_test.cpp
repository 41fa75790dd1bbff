#include "research/rhythm/dance_beats.h"

#include <gtest/gtest.h>

#include <cmath>

#include "research/rhythm/steps_eval.h"

namespace dance {
namespace {

BeatGrid steady(double tempo_bpm) {
  std::vector<GridBeat> beats;
  for (int i = 0; i < 400; ++i) beats.push_back({0.1 + i * 60.0 / tempo_bpm, 1 + i % 4});
  return *BeatGrid::make(beats);
}

BeatDance salsa(SalsaRole role, double tempo_bpm) {
  return salsa_to_music(role, 9, 0.0, Duration::s(30), steady(tempo_bpm), 60.0);
}

SeenSteps seen(const BeatDance& dance) { return steps_of(dance.skeleton, dance.poses, 60.0); }

double in_bar(double beats) { return beats - 4.0 * std::round(beats / 4.0); }

TEST(DanceBeats, AreFoundByEachPartnerAndByBoth) {
  for (const double bpm : {125.0, 164.0, 200.0}) {
    const std::array<BeatDance, 2> couple{salsa(SalsaRole::kLead, bpm),
                                          salsa(SalsaRole::kFollow, bpm)};
    const std::array<SeenSteps, 2> steps{seen(couple[0]), seen(couple[1])};
    const std::span<const SeenSteps> both = steps;
    for (const std::span<const SeenSteps> dancers : {both, both.first(1), both.last(1)}) {
      const DanceBeats beats = find_dance_beats(dancers);
      EXPECT_NEAR(beats.tempo_bpm, bpm, 2.0);
      for (double t_s = 8.0; t_s < 24.0; t_s += 1.0) {
        const double truth = couple[0].beats[static_cast<std::size_t>(t_s * 60.0)];
        EXPECT_LT(std::abs(in_bar(beats.beats_at(t_s) - truth)), 0.1) << bpm << ' ' << t_s;
        EXPECT_NEAR(beats.time_of(beats.beats_at(t_s)), t_s, 1e-6);
        EXPECT_GT(beats.strength_at(t_s), static_cast<double>(dancers.size())) << bpm;
      }
    }
  }
}

TEST(DanceBeats, LieOnTheBeatsOfAnotherSong) {
  const BeatDance dance = salsa(SalsaRole::kLead, 164.0);
  CodecTake take;
  take.skeleton = dance.skeleton;
  take.hz = 60.0;
  take.poses = dance.poses;
  const SeenSteps steps = seen(dance);
  const BeatGrid song = steady(150.0);
  const BeatDance laid = lay_onto_beats(take, find_dance_beats(std::span(&steps, 1)), song, 60.0);
  EXPECT_NEAR(static_cast<double>(laid.poses.size()), 30.0 * 60.0 * 164.0 / 150.0, 180.0);
  const SeenSteps again = seen(laid);
  const DanceBeats beats = find_dance_beats(std::span(&again, 1));
  EXPECT_NEAR(beats.tempo_bpm, 150.0, 2.0);
  for (double t_s = 8.0; t_s < 24.0; t_s += 1.0)
    EXPECT_LT(std::abs(in_bar(beats.beats_at(t_s) - song.beat_at(t_s))), 0.1) << t_s;
}

TEST(LearnSteps, OfSyntheticDancersFindOthersOfThem) {
  std::vector<SeenSteps> steps;
  std::vector<DanceBeats> beats;
  for (const double bpm : {140.0, 160.0, 180.0}) {
    steps.push_back(seen(salsa(SalsaRole::kLead, bpm)));
    beats.push_back(find_dance_beats(std::span(&steps.back(), 1)));
  }
  std::vector<KnownDance> known;
  for (std::size_t i = 0; i < steps.size(); ++i) known.push_back({&steps[i], &beats[i], 1.0});
  const StepPattern learnt = learn_steps(known, salsa_steps());
  // Synthetic dancers are more alike than people.
  EXPECT_LT(learnt.spread[StepPattern::kLeftFoot], salsa_steps().spread[StepPattern::kLeftFoot]);
  const BeatDance other = salsa(SalsaRole::kFollow, 170.0);
  const StepsScore score = steps_score(other, told_by_steps(other, 170.0, learnt), 170.0);
  EXPECT_GT(score.known, 0.7);
  EXPECT_LT(std::abs(score.mean_ms), 30.0);
  EXPECT_LT(score.sd_ms, 30.0);
  EXPECT_GT(score.same_beat, 0.95);
  // What nobody has danced strongly enough teaches nothing.
  for (KnownDance& dance : known) dance.least_strength = 100.0;
  EXPECT_EQ(learn_steps(known, salsa_steps()).wave, salsa_steps().wave);
}

TEST(StepsScore, TellsLatenessFoldedToABeatAndWhetherItIsTheRightBeat) {
  BeatDance dance;
  ToldBeats told;
  for (int i = 0; i < 600; ++i) {
    dance.beats.push_back(i / 20.0);
    // Half is told; late by a tenth of a beat, and a third of that a beat further on.
    if (i < 300)
      told.push_back(i / 20.0 + 0.1 + (i < 100 ? 1.0 : 4.0));
    else
      told.push_back(std::nullopt);
  }
  const StepsScore score = steps_score(dance, told, 120.0);
  EXPECT_NEAR(score.known, 0.5, 1e-9);
  EXPECT_NEAR(score.mean_ms, 50.0, 1e-6);
  EXPECT_NEAR(score.sd_ms, 0.0, 1e-6);
  EXPECT_NEAR(score.same_beat, 2.0 / 3.0, 1e-9);
}

TEST(StepsScore, KnowsLittleOfADanceInAnotherOrderAndOfWhoStands) {
  const BeatDance dance = salsa(SalsaRole::kLead, 150.0);
  EXPECT_GT(steps_score(dance, told_by_steps(dance, 150.0, salsa_steps()), 150.0).known, 0.6);
  for (const BeatDance& none : {shuffled(dance, 3), standing(dance, 3)}) {
    EXPECT_EQ(none.poses.size(), none.beats.size());
    EXPECT_LT(steps_score(none, told_by_steps(none, 150.0, salsa_steps()), 150.0).known, 0.1)
        << none.name;
  }
}

}  // namespace
}  // namespace dance
