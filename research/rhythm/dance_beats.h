// The beats that dancers danced to, found from their steps over a whole take: for evaluations,
// which need a truth for takes that came without their music. A couple hears one music: both
// partners' steps tell more than one's, and one's tell what the other's are judged by.
//
// Units/frames: seconds from the take's begin; beats from somewhere, whole bars of four are bars of
//               the dance.
// Ownership:    plain values.
// Threads:      none inside.
// Failure:      a take in which nobody steps gets beats all the same; strength says what they are
//               worth.
#pragma once

#include <span>
#include <vector>

#include "research/codec_takes.h"
#include "transformers/tempo/step_pattern.h"
#include "transformers/tempo/step_signs.h"

namespace dance {

using SeenSteps = std::vector<StepSigns::Slot>;
// Slots of a dance, their times from MonoTime() at its begin.
SeenSteps steps_of(const Skeleton& skeleton, std::span<const Pose> poses, double hz);

struct DanceBeats {
  double tempo_bpm = 0.0;
  std::vector<double> offset_beats;  // each half second: beats are tempo * time + offset
  // How much of the pattern there is about each half second: 0, to about 2 for each dancer.
  std::vector<double> strength;

  static constexpr double kEvery_s = 0.5;
  double beats_at(double t_s) const;
  double time_of(double beats) const;
  double strength_at(double t_s) const;
};

// Of all tempos the one at which the steps fit the pattern best, where the place in the bar may
// wander slowly: twelve seconds are looked at together. Of one dancer, or of a couple.
DanceBeats find_dance_beats(std::span<const SeenSteps> dancers,
                            const StepPattern& pattern = salsa_steps());

// The pattern of dances whose beats are known: each sign's mean over eight counts. Which foot began
// is told by `like`.
struct KnownDance {
  const SeenSteps* steps = nullptr;
  const DanceBeats* beats = nullptr;
  double least_strength = 0.0;  // what is weaker is left out
};
StepPattern learn_steps(std::span<const KnownDance> dances, const StepPattern& like);

}  // namespace dance
