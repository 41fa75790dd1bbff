// BeatTracker: a causal, streaming beat tracker for music without a list of its beats. After each
// hop of 10 ms it predicts the time of the next beat, its number and the tempo, between 72 and 214
// beats a minute, of the beats that dancers step on.
//
// Units/frames: mono samples at a given rate. Times in Beat count from the first sample on a clock
//               that has zero there; the caller adds the time at which that was heard. A hop costs
//               about 0.5 ms of one core.
// Ownership:    owns its tables, about 3.5 MB; never allocates after construction.
// Threads:      none inside; one owner.
// Failure:      samples that are not finite count as silence. beat().playing is false before the
//               first two seconds of sound and in silence of more than four; the phase lock goes on
//               inside.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "core/base/beat.h"
#include "producers/music/tracker/bar_pointer.h"
#include "producers/music/tracker/beat_model.h"
#include "producers/music/tracker/beat_phase_lock.h"
#include "producers/music/tracker/onset_strength.h"
#include "producers/music/tracker/tempo/tempo_evidence.h"

namespace dance {

class BeatTracker {
 public:
  // The rate is between kLeastRate_hz and kMostRate_hz.
  explicit BeatTracker(double sample_rate_hz,
                       std::shared_ptr<const BeatModel> model = built_in_beat_model());

  static constexpr double kLeastRate_hz = OnsetStrength::kLeastRate_hz;
  static constexpr double kMostRate_hz = OnsetStrength::kMostRate_hz;

  // Any number of samples; returns how many hops they ended.
  int push(std::span<const float> samples);
  std::size_t hop_samples() const { return onsets_.hop_samples(); }

  // What the dancers' steps say, until another is given. Before a song of which nothing is known,
  // give TempoHint{}.
  void set_tempo_hint(const TempoHint& hint) { tempo_.set_hint(hint); }

  // What is known at the end of the newest hop.
  const Beat& beat() const { return beat_; }

 private:
  void end_hop();

  OnsetStrength onsets_;
  double hop_s_;
  std::shared_ptr<const BeatModel> model_;
  RhythmFeatures features_;
  RhythmState heard_;
  StrokeMeaning meaning_;
  BarPointer pointer_;
  TempoEvidence tempo_;
  BeatPhaseLock lock_;
  std::vector<float> hop_;
  std::size_t filled_ = 0;
  std::int64_t hops_ = 0;
  std::int64_t sounding_hops_ = 0;
  std::int64_t since_stroke_hops_ = 1000;
  Beat beat_;
};

}  // namespace dance
