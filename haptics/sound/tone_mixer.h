// ToneMixer: what is to be felt as sound for tactors: a tone for each, with its envelope, from the
// frame on at which it is due.
//
// Units/frames: samples -limit to limit, 1 without one; frames at rate_hz.
// Ownership:    kMostTones at a time, the one that ends first gives way; never allocates.
// Threads:      none inside; one owner.
// Failure:      none.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <span>

#include "core/signal/haptic.h"

namespace dance {

class ToneMixer {
 public:
  static constexpr std::size_t kMostTones = 8;
  static constexpr float kUsual_hz = 120.0f;
  // Without a ramp a tone would click.
  static constexpr Duration kLeastRamp = Duration::ms(4);

  explicit ToneMixer(double rate_hz) : rate_hz_(rate_hz) {}

  // Begins with the next frame that is mixed.
  void add(Haptic haptic) {
    const Duration most_ramp = haptic.duration / 2;
    haptic.attack = std::max(haptic.attack, std::min(kLeastRamp, most_ramp));
    haptic.release =
        std::min(std::max(haptic.release, kLeastRamp), haptic.duration - haptic.attack);
    Tone* place = tones_.data();
    for (Tone& tone : tones_)
      if (tone.left() < place->left()) place = &tone;
    place->haptic = haptic;
    place->frame = 0;
    place->frames = static_cast<std::int64_t>(haptic.duration.as_seconds() * rate_hz_);
  }
  void clear() { tones_ = {}; }
  bool is_silent() const {
    return std::all_of(tones_.begin(), tones_.end(), [](const Tone& t) { return t.left() == 0; });
  }

  // Of the sum of all tones, 0 to 1.
  void set_limit(float limit) { limit_ = limit; }

  void mix(std::span<float> samples) {
    std::fill(samples.begin(), samples.end(), 0.0f);
    for (Tone& tone : tones_) {
      const float hz = tone.haptic.frequency_hz > 0.0f ? tone.haptic.frequency_hz : kUsual_hz;
      const double step = 2.0 * std::numbers::pi * static_cast<double>(hz) / rate_hz_;
      for (float& sample : samples) {
        if (tone.left() == 0) break;
        const double since_s = static_cast<double>(tone.frame) / rate_hz_;
        sample += tone.haptic.amplitude_at(Duration::seconds(since_s)) *
                  static_cast<float>(std::sin(step * static_cast<double>(tone.frame)));
        ++tone.frame;
      }
    }
    for (float& sample : samples) sample = std::clamp(sample, -limit_, limit_);
  }

 private:
  struct Tone {
    Haptic haptic;
    std::int64_t frame = 0, frames = 0;
    std::int64_t left() const { return frames - frame; }
  };
  double rate_hz_;
  float limit_ = 1.0f;
  std::array<Tone, kMostTones> tones_{};
};

}  // namespace dance
