// Music made in a test: bass drum, snare, cymbals and chords on beats that are known exactly.
//
// Units/frames: seconds from the first sample; samples -1 to 1.
// Ownership:    plain values.
// Threads:      none inside.
// Failure:      none.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

#include "core/base/random.h"

namespace dance {

class DrumMusic {
 public:
  explicit DrumMusic(double rate_hz) : rate_hz_(rate_hz) {}

  // Beats from 0.3 s on; tempo_bpm says how fast it goes after each.
  static std::vector<double> beats(double seconds, const std::function<double(double)>& tempo_bpm) {
    std::vector<double> times_s;
    for (double t = 0.3; t < seconds; t += 60.0 / tempo_bpm(t)) times_s.push_back(t);
    return times_s;
  }
  static std::vector<double> steady(double seconds, double bpm) {
    return beats(seconds, [bpm](double) { return bpm; });
  }

  // A rock beat: bass drum on one and three, snare on two and four, cymbals on the halves, a chord
  // a bar. Between quiet_from_s and quiet_to_s nothing sounds.
  std::vector<float> play(const std::vector<double>& beats_s, double seconds,
                          double quiet_from_s = 1e9, double quiet_to_s = 1e9) const {
    std::vector<float> out(static_cast<std::size_t>(seconds * rate_hz_), 0.0f);
    constexpr double kRoots_hz[] = {110.0, 146.8, 164.8, 98.0};
    for (std::size_t i = 0; i + 1 < beats_s.size(); ++i) {
      const double length_s = beats_s[i + 1] - beats_s[i];
      if (beats_s[i] >= quiet_from_s && beats_s[i] < quiet_to_s) continue;
      if (i % 2 == 0)
        tone(out, beats_s[i], 58.0, 0.12, 0.8);
      else
        noise(out, beats_s[i], 0.06, 0.35, i);
      noise(out, beats_s[i], 0.015, 0.2, 1000 + i);
      noise(out, beats_s[i] + 0.5 * length_s, 0.015, 0.12, 2000 + i);
      if (i % 4 == 0)
        for (const double ratio : {2.0, 2.52, 3.0})
          tone(out, beats_s[i], kRoots_hz[i / 4 % 4] * ratio, 3.0 * length_s, 0.08);
    }
    return out;
  }

  // Salsa: son clave, the bass before the beat, a bell on one and three, congas; chords come with
  // the bass.
  std::vector<float> play_salsa(const std::vector<double>& beats_s, double seconds) const {
    std::vector<float> out(static_cast<std::size_t>(seconds * rate_hz_), 0.0f);
    for (std::size_t bar = 0; 4 * bar + 4 < beats_s.size(); ++bar) {
      const auto at = [&](double beat) {
        const auto i = 4 * bar + static_cast<std::size_t>(beat);
        return beats_s[i] + (beat - std::floor(beat)) * (beats_s[i + 1] - beats_s[i]);
      };
      const double root_hz = bar / 2 % 2 == 0 ? 110.0 : 146.8;
      for (const double beat : {1.5, 3.0}) tone(out, at(beat), 0.5 * root_hz, 0.25, 0.5);
      for (const double ratio : {2.0, 2.52, 3.0}) tone(out, at(1.5), root_hz * ratio, 0.4, 0.08);
      for (int eighth = 0; eighth < 8; ++eighth)
        noise(out, at(0.5 * eighth), 0.012, 0.1, 100 * bar + static_cast<std::size_t>(eighth));
      for (const double beat : {0.0, 2.0}) tone(out, at(beat), 2400.0, 0.05, 0.12);
      noise(out, at(1.0), 0.03, 0.2, 7 * bar);
      for (const double beat : {3.0, 3.5}) tone(out, at(beat), 220.0, 0.12, 0.3);
      if (bar % 2 == 0)
        for (const double beat : {0.0, 1.5, 3.0}) tone(out, at(beat), 3100.0, 0.02, 0.3);
      else
        for (const double beat : {1.0, 2.0}) tone(out, at(beat), 3100.0, 0.02, 0.3);
    }
    return out;
  }

  std::vector<float> clicks(const std::vector<double>& beats_s, double seconds) const {
    std::vector<float> out(static_cast<std::size_t>(seconds * rate_hz_), 0.0f);
    for (std::size_t i = 0; i < beats_s.size(); ++i) noise(out, beats_s[i], 0.004, 0.7, i);
    return out;
  }

  void tone(std::vector<float>& out, double at_s, double hz, double decay_s, double level) const {
    const auto first = static_cast<std::size_t>(at_s * rate_hz_);
    for (std::size_t i = first; i < out.size(); ++i) {
      const double t = static_cast<double>(i - first) / rate_hz_;
      if (t > 6.0 * decay_s) break;
      out[i] += static_cast<float>(level * std::exp(-t / decay_s) *
                                   std::sin(2.0 * std::numbers::pi * hz * t));
    }
  }
  void noise(std::vector<float>& out, double at_s, double decay_s, double level,
             std::uint64_t seed) const {
    Random random(seed + 1);
    const auto first = static_cast<std::size_t>(at_s * rate_hz_);
    for (std::size_t i = first; i < out.size(); ++i) {
      const double t = static_cast<double>(i - first) / rate_hz_;
      if (t > 6.0 * decay_s) break;
      out[i] += static_cast<float>(level * std::exp(-t / decay_s) * random.uniform(-1.0, 1.0));
    }
  }

 private:
  double rate_hz_;
};

}  // namespace dance
