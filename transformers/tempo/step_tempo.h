// StepTempo: the tempo at which the dancers of a room step, and how far they agree: what may tell a
// beat tracker whether a music is danced at one level or at half or double of it.
//
// Units/frames: steps a minute. A dancer counts as much as the dance is like itself.
// Ownership:    a fixed array; never allocates.
// Threads:      none inside; one owner.
// Failure:      weight 0 until a dancer's tempo has been known for some seconds.
#pragma once

#include <array>
#include <cstddef>

#include "core/base/time.h"

namespace dance {

class StepTempo {
 public:
  static constexpr double kLeast_bpm = 50.0;
  static constexpr double kMost_bpm = 250.0;

  // Some times a second: what each dancer's Period says, its tempo and coherence, and then that so
  // much time is over. A tempo beyond the bounds, or of a dance that is less like itself than
  // counts, is passed over: then see() is false.
  bool see(double tempo_bpm, float coherence);
  void pass(Duration time);
  void forget() { *this = StepTempo(); }

  double tempo_bpm() const { return tempo_bpm_; }  // 0: not known
  // 0 = unknown … 1 = seen for long, and all dancers agree.
  double weight() const { return weight_; }

 private:
  static constexpr int kBinsPerOctave = 12;
  static constexpr std::size_t kBins = 29;

  void choose();

  std::array<double, kBins> now_{};   // what was seen since the last pass
  std::array<double, kBins> seen_{};  // dancers' seconds at each tempo, decaying
  double tempo_bpm_ = 0.0;
  double weight_ = 0.0;
};

}  // namespace dance
