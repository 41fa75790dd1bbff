// Musical time from steps alone, judged: how much of a dance is called known, and how far what is
// told then lies from the beats that the dance was laid onto. Beside it what the period alone
// tells, and dances that are none.
//
// Units/frames: milliseconds of the music that is danced to; late is positive.
// Ownership:    plain values.
// Threads:      none inside.
// Failure:      a dance of which nothing is known has no errors.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "research/rhythm/rhythm_eval.h"

namespace dance {

struct StepsScore {
  double known = 0.0;  // share of the dance, from its first pose on
  double mean_ms = 0.0, sd_ms = 0.0;
  double same_beat = 0.0;  // share of what is known that is on the right one of four beats
};

struct StepsRow {
  std::string name;
  double stands_ms = 0.0;                 // when feet come to stand, after their beat
  StepsScore period, ours, others_steps;  // the last: our filter, with steps learnt from others
};

// Musical time of the untagged dance at each pose, where it is known.
using ToldBeats = std::vector<std::optional<double>>;
ToldBeats told_by_steps(const BeatDance& dance, double music_bpm, const StepPattern& pattern);
ToldBeats told_by_period(const BeatDance& dance, double music_bpm);
// Against the beats that the dance was danced to.
StepsScore steps_score(const BeatDance& dance, const ToldBeats& told, double music_bpm);

// When feet that swung come to stand, after the beat they are nearest to, on average.
double feet_stand_ms(const BeatDance& dance, double music_bpm);

// The same dance with its seconds in another order, and somebody who stands as its first pose does.
BeatDance shuffled(const BeatDance& dance, std::uint64_t seed);
BeatDance standing(const BeatDance& dance, std::uint64_t seed);

std::string steps_table(const std::vector<StepsRow>& rows, const std::vector<StepsRow>& none);

}  // namespace dance
