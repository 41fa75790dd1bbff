#include "transformers/tempo/step_tempo.h"

#include <algorithm>
#include <cmath>

namespace dance {
namespace {

constexpr double kMemory_s = 20.0;
// A dance less like itself than this tells no tempo.
constexpr float kLeastCoherence = 0.4f;
// What one dancer brings in eight seconds is believed.
constexpr double kBelieved_s = 8.0;
constexpr double kLongestStep_s = 0.5;

}  // namespace

bool StepTempo::see(double tempo_bpm, float coherence) {
  if (!(tempo_bpm >= kLeast_bpm && tempo_bpm <= kMost_bpm && coherence >= kLeastCoherence))
    return false;
  const double bin = kBinsPerOctave * std::log2(tempo_bpm / kLeast_bpm);
  const auto below = std::min(static_cast<std::size_t>(bin), kBins - 2);
  const double part = bin - static_cast<double>(below);
  now_[below] += (1.0 - part) * static_cast<double>(coherence);
  now_[below + 1] += part * static_cast<double>(coherence);
  return true;
}

void StepTempo::pass(Duration time) {
  const double time_s = std::clamp(time.as_seconds(), 0.0, kLongestStep_s);
  const double kept = std::exp(-std::max(0.0, time.as_seconds()) / kMemory_s);
  for (std::size_t bin = 0; bin < kBins; ++bin) seen_[bin] = kept * seen_[bin] + time_s * now_[bin];
  now_.fill(0.0);
  choose();
}

// The place of the most, and how much of all lies there: dancers at another level speak against it.
void StepTempo::choose() {
  double all = 0.0, most = 0.0;
  std::size_t best = 0;
  const auto near = [&](std::size_t bin) {
    return seen_[bin] + (bin > 0 ? seen_[bin - 1] : 0.0) + (bin + 1 < kBins ? seen_[bin + 1] : 0.0);
  };
  for (std::size_t bin = 0; bin < kBins; ++bin) {
    all += seen_[bin];
    if (near(bin) > most) {
      most = near(bin);
      best = bin;
    }
  }
  weight_ = 0.0;
  tempo_bpm_ = 0.0;
  if (most <= 0.0) return;
  double centre = 0.0;
  for (std::size_t bin = best > 0 ? best - 1 : 0; bin <= std::min(best + 1, kBins - 1); ++bin)
    centre += static_cast<double>(bin) * seen_[bin] / most;
  tempo_bpm_ = kLeast_bpm * std::exp2(centre / kBinsPerOctave);
  weight_ = std::min(1.0, all / kBelieved_s) * std::max(0.0, 2.0 * most / all - 1.0);
}

}  // namespace dance
