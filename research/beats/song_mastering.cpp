#include "research/beats/song_mastering.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/random.h"
#include "research/beats/music_samples.h"

namespace dance {
namespace {

// What lies between studios, for better and worse than one would choose.
constexpr double kBassBelow_hz = 150.0, kTrebleAbove_hz = 2500.0, kElsewhere_octaves = 0.8;
constexpr double kMostBass_db = 9.0, kMostMiddle_db = 6.0, kMostTreble_db = 9.0;
constexpr double kShortestRelease_s = 0.05, kLongestRelease_s = 0.3;
constexpr double kMostCompressed = 0.8;  // of decibels
constexpr double kMostDriven_db = 15.0;
constexpr double kLeastHiss_db = -70.0, kMostHiss_db = -40.0;
// A compressor lifts no more than this, of the loudest sample.
constexpr float kFaintestLifted = 0.03f;

// Follows what it hears below `hz`.
class LowPass {
 public:
  LowPass(double hz, double rate_hz)
      : share_(static_cast<float>(1.0 - std::exp(-2.0 * std::numbers::pi * hz / rate_hz))) {}
  float push(float x) { return value_ += share_ * (x - value_); }

 private:
  float share_;
  float value_ = 0.0f;
};

void turn_knobs(std::vector<float>& samples, double rate_hz, Random& random) {
  const auto about = [&](double hz) {
    return hz * std::exp2(random.uniform(-kElsewhere_octaves, kElsewhere_octaves));
  };
  LowPass bass(about(kBassBelow_hz), rate_hz);
  LowPass below_treble(about(kTrebleAbove_hz), rate_hz);
  const auto knob = [&](double most_db) { return gain_of_db(random.uniform(-most_db, most_db)); };
  const float bass_gain = knob(kMostBass_db);
  const float middle_gain = knob(kMostMiddle_db);
  const float treble_gain = knob(kMostTreble_db);
  for (float& x : samples) {
    const float low = bass.push(x);
    const float low_and_middle = below_treble.push(x);
    x = bass_gain * low + middle_gain * (low_and_middle - low) + treble_gain * (x - low_and_middle);
  }
}

void make_loud(std::vector<float>& samples, double rate_hz, Random& random) {
  float loudest = 1e-6f;
  for (const float x : samples) loudest = std::max(loudest, std::abs(x));
  const double release_s = random.uniform(kShortestRelease_s, kLongestRelease_s);
  const auto kept = static_cast<float>(std::exp(-1.0 / (rate_hz * release_s)));
  const auto compressed = static_cast<float>(random.uniform(0.0, kMostCompressed));
  const float drive = gain_of_db(random.uniform(0.0, kMostDriven_db));
  const float hiss = gain_of_db(random.uniform(kLeastHiss_db, kMostHiss_db));
  float level = kFaintestLifted;
  for (float& x : samples) {
    const float in = x / loudest;
    level = std::max({std::abs(in), kept * level, kFaintestLifted});
    x = std::tanh(drive * in * std::pow(level, -compressed)) +
        hiss * static_cast<float>(random.uniform(-1.0, 1.0));
  }
}

}  // namespace

std::vector<float> mastered(std::vector<float> samples, double rate_hz, std::uint64_t seed) {
  Random random(seed);
  turn_knobs(samples, rate_hz, random);
  make_loud(samples, rate_hz, random);
  return samples;
}

}  // namespace dance
