// StepsHint: the tempo hint of a tracker, by what is heard of the dancers on STEPS/local, or by
// what a person said.
//
// Units/frames: steps a minute; times of this house's clock.
// Ownership:    plain value.
// Threads:      none inside; one owner.
// Failure:      steps that were not heard of for kTimeout say nothing, and neither does anything
//               but a tempo that people step at. What a bus says weighs kMostWeight at most: it
//               turns a rhythm that fits two levels, and none that clearly has one.
#pragma once

#include "core/base/steps.h"
#include "producers/music/tracker/tempo/tempo_evidence.h"

namespace dance {

class StepsHint {
 public:
  static constexpr Duration kTimeout = Duration::s(3);
  static constexpr double kLeastStep_bpm = 50.0;
  static constexpr double kMostStep_bpm = 250.0;
  static constexpr double kMostWeight = 0.75;
  static constexpr double kMostRemoteWeight = 0.4;

  // What a person said is not changed by what dancers do.
  explicit StepsHint(const TempoHint& said = {}) : said_(said) {}

  void hear(const Steps& steps, MonoTime now) {
    steps_ = steps;
    heard_ = now;
  }

  TempoHint at(MonoTime now) const {
    if (said_.tempo_bpm > 0.0 && said_.weight > 0.0) return said_;
    if (!heard_.is_set() || now - heard_ > kTimeout) return {};
    if (steps_.tempo_bpm < kLeastStep_bpm || steps_.tempo_bpm > kMostStep_bpm) return {};
    const double most = steps_.is_remote ? kMostRemoteWeight : kMostWeight;
    return {steps_.tempo_bpm, most * static_cast<double>(steps_.weight)};
  }

 private:
  TempoHint said_;
  Steps steps_;
  MonoTime heard_;
};

}  // namespace dance
