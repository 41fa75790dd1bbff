// Steps: the tempo at which the dancers of a house step, as their poses show it. What tracks the
// beats of music may ask which level of it people dance to.
//
// Units/frames: steps a minute. The time is of the clock that clock_id names.
// Ownership:    plain value.
// Threads:      none inside.
// Failure:      is_valid() is false for a tempo outside 20 to 400 that is not 0, for a weight
//               outside 0 to 1, and for a weight where there is no tempo.
#pragma once

#include <cstdint>

#include "core/base/beat.h"
#include "core/base/time.h"

namespace dance {

struct Steps {
  MonoTime time;  // when this was published
  std::uint64_t clock_id = 0;
  double tempo_bpm = 0.0;  // 0: not known
  float weight = 0.0f;     // 0 = no evidence of the music … 1 = certain
  int dancers = 0;         // the number whose steps these are
  bool is_remote = false;  // guests of other houses: nobody dances here
};

constexpr int kMostStepsDancers = 127;

inline bool is_valid(const Steps& steps) {
  const bool is_known = steps.tempo_bpm >= kLeastTempo_bpm && steps.tempo_bpm <= kMostTempo_bpm;
  return (is_known || (steps.tempo_bpm == 0.0 && steps.weight == 0.0f)) && steps.weight >= 0.0f &&
         steps.weight <= 1.0f && steps.dancers >= 0 && steps.dancers <= kMostStepsDancers;
}

}  // namespace dance
