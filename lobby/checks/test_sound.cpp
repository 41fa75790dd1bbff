#include "lobby/checks/test_sound.h"

#include <array>
#include <cmath>
#include <numbers>

namespace dance {
namespace {

constexpr double kRate_hz = 48'000.0;
constexpr std::int64_t kBeat = kCountInSamples / 4;
constexpr std::int64_t kTone = 9600;  // samples; the rest of a beat is silent
constexpr std::array<double, 4> kTones_hz{523.25, 587.33, 659.25, 1046.5};
constexpr double kLoudness = 0.3;
constexpr double kSweepLoudness = 0.5;
constexpr double kSweepFrom_hz = 600.0;
constexpr double kSweepTo_hz = 5000.0;

// Rises and falls without a click.
double envelope(double share) {
  const double wave = std::sin(std::numbers::pi * share);
  return wave * wave;
}

}  // namespace

float count_in_sample(std::int64_t index) {
  if (index < 0 || index >= kCountInSamples) return 0.0f;
  const std::int64_t in_beat = index % kBeat;
  if (in_beat >= kTone) return 0.0f;
  const double t = static_cast<double>(in_beat);
  const double tone = std::sin(2.0 * std::numbers::pi *
                               kTones_hz[static_cast<std::size_t>(index / kBeat)] * t / kRate_hz);
  return static_cast<float>(kLoudness * envelope(t / kTone) * tone);
}

std::span<const float, kSweepSamples> test_sweep() {
  static const std::array<float, kSweepSamples> sweep = [] {
    std::array<float, kSweepSamples> samples{};
    const double seconds = kSweepSamples / kRate_hz;
    for (std::size_t i = 0; i < samples.size(); ++i) {
      const double t = static_cast<double>(i) / kRate_hz;
      const double cycles =
          kSweepFrom_hz * t + 0.5 * (kSweepTo_hz - kSweepFrom_hz) / seconds * t * t;
      samples[i] = static_cast<float>(kSweepLoudness * envelope(t / seconds) *
                                      std::sin(2.0 * std::numbers::pi * cycles));
    }
    return samples;
  }();
  return sweep;
}

}  // namespace dance
