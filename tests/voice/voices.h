// What the tests of voices share: a voice that is no recording (a pitch that glides, with formants
// and pauses), for tests without espeak-ng.
//
// Units/frames: mono samples at 48 kHz.
// Ownership:    plain values.
// Threads:      none inside.
// Failure:      none.
#pragma once

#include <cmath>
#include <numbers>
#include <vector>

namespace dance {

// Syllables of 250 ms; with pauses, one second in three is silent.
inline std::vector<float> hummed(double seconds, bool has_pauses, double pitch_hz = 140.0) {
  constexpr double kHz = 48'000.0;
  constexpr double pi = std::numbers::pi;
  std::vector<float> samples(static_cast<std::size_t>(seconds * kHz));
  double phase = 0.0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const double t = static_cast<double>(i) / kHz;
    phase += 2.0 * pi * pitch_hz * (1.0 + 0.2 * std::sin(2.0 * pi * 0.7 * t)) / kHz;
    double sum = 0.0;
    for (int harmonic = 1; harmonic <= 20; ++harmonic) {
      const double f = pitch_hz * harmonic;
      const double formant = std::exp(-std::pow((f - 600.0) / 300.0, 2)) +
                             0.5 * std::exp(-std::pow((f - 1500.0) / 400.0, 2)) + 0.02;
      sum += formant * std::sin(harmonic * phase);
    }
    const double syllable = std::pow(std::sin(pi * 4.0 * t), 2);
    const bool is_pause = has_pauses && std::fmod(t, 3.0) >= 2.0;
    samples[i] = is_pause ? 0.0f : static_cast<float>(0.15 * sum * (0.2 + 0.8 * syllable));
  }
  return samples;
}

}  // namespace dance
