#include "testing/motion/beat_phase.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

namespace dance {
namespace {

using Complex = std::complex<double>;
constexpr double kBar_beats = 4.0;
constexpr double kLeastCoherence = 0.6;
// Joints that swing by a millimetre: 21 of them, summed over the steps of a bar.
constexpr double kLeastPower = 5e-3;
constexpr int kRounds = 3;
constexpr std::size_t kChannels = 3 * (kBoneCount - 1);
using Wave = std::array<Complex, kChannels>;

// The track at a musical time, between frames; false outside.
bool joints_at(const DanceOnBeats& dance, double beats, std::array<double, kChannels>& out) {
  const auto after = std::lower_bound(dance.beats.begin(), dance.beats.end(), beats);
  if (after == dance.beats.begin() || after == dance.beats.end()) return false;
  const auto i = static_cast<std::size_t>(after - dance.beats.begin());
  const double span = dance.beats[i] - dance.beats[i - 1];
  const auto f = static_cast<float>(span > 0.0 ? (beats - dance.beats[i - 1]) / span : 1.0);
  for (std::size_t b = 1; b < kBoneCount; ++b) {
    const Eigen::Vector3f p =
        dance.track->body[i - 1][b] + f * (dance.track->body[i][b] - dance.track->body[i - 1][b]);
    for (std::size_t k = 0; k < 3; ++k)
      out[3 * (b - 1) + k] = static_cast<double>(p[static_cast<Eigen::Index>(k)]);
  }
  return true;
}

// z = sum over one bar around `beats` of y(b) e^(-i pi b / 2), the mean taken off.
bool wave_at(const DanceOnBeats& dance, double beats, Wave& z) {
  constexpr int kSteps = 32;
  std::array<std::array<double, kChannels>, kSteps> y;
  std::array<double, kChannels> mean{};
  for (int s = 0; s < kSteps; ++s) {
    const double b = beats + kBar_beats * ((s + 0.5) / kSteps - 0.5);
    if (!joints_at(dance, b, y[static_cast<std::size_t>(s)])) return false;
    for (std::size_t c = 0; c < kChannels; ++c)
      mean[c] += y[static_cast<std::size_t>(s)][c] / kSteps;
  }
  z.fill(0.0);
  for (int s = 0; s < kSteps; ++s) {
    const double b = beats + kBar_beats * ((s + 0.5) / kSteps - 0.5);
    const Complex turn = std::polar(1.0, -2.0 * std::numbers::pi * b / kBar_beats);
    for (std::size_t c = 0; c < kChannels; ++c)
      z[c] += (y[static_cast<std::size_t>(s)][c] - mean[c]) * turn;
  }
  return true;
}

// Adds to `error` by how much the wave `z` is behind `z_truth`, which is `behind` before it; false
// where they are not alike.
bool lateness(const Wave& z, const Wave& z_truth, double behind, double& error) {
  Complex together = 0.0;
  double power = 0.0, power_truth = 0.0;
  for (std::size_t c = 0; c < kChannels; ++c) {
    together += z[c] * std::conj(z_truth[c]);
    power += std::norm(z[c]);
    power_truth += std::norm(z_truth[c]);
  }
  const double both = std::sqrt(power * power_truth);
  if (both <= kLeastPower || std::abs(together) < kLeastCoherence * both) return false;
  // Shown late by e, y(b) = truth(b - behind - e): the wave is turned by -2 pi (behind + e) / 4.
  together *= std::polar(1.0, 2.0 * std::numbers::pi * behind / kBar_beats);
  error -= std::arg(together) * kBar_beats / (2.0 * std::numbers::pi);
  return true;
}

}  // namespace

BeatPhase beat_phase(const DanceOnBeats& shown, const DanceOnBeats& truth,
                     const std::vector<double>& offset_beats, std::size_t from, std::size_t to,
                     double fold_beats) {
  BeatPhase phase;
  std::size_t looked_at = 0;
  Wave z, z_truth;
  Complex circle = 0.0;
  for (std::size_t i = from; i < std::min(to, shown.beats.size()); i += 3) {
    const double b = shown.beats[i], offset = offset_beats[i];
    if (!wave_at(shown, b, z) || !wave_at(truth, b - offset, z_truth)) continue;
    ++looked_at;
    if (std::any_of(shown.jumps.begin(), shown.jumps.end(),
                    [b](double jump) { return std::abs(jump - b) < 0.5 * kBar_beats; }))
      continue;
    double error = 0.0;
    bool tells = true;
    // The truth is looked at where it was found last: bars differ, and the same one is meant.
    for (int round = 0; round < kRounds && tells; ++round) {
      tells = (round == 0 || wave_at(truth, b - offset - error, z_truth)) &&
              lateness(z, z_truth, offset + error, error);
    }
    if (!tells) continue;
    error -= fold_beats * std::round(error / fold_beats);
    phase.errors_beats.push_back(error);
    phase.at_beats.push_back(b);
    circle += std::polar(1.0, 2.0 * std::numbers::pi * error / fold_beats);
  }
  if (phase.errors_beats.empty()) return phase;
  const auto n = static_cast<double>(phase.errors_beats.size());
  phase.told = n / static_cast<double>(looked_at);
  phase.mean_beats = std::arg(circle) * fold_beats / (2.0 * std::numbers::pi);
  for (const double error : phase.errors_beats) {
    double off = error - phase.mean_beats;
    off -= fold_beats * std::round(off / fold_beats);
    phase.sd_beats += off * off / n;
  }
  phase.sd_beats = std::sqrt(phase.sd_beats);
  return phase;
}

}  // namespace dance
