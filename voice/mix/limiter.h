// Limiter: keeps a stereo mix below full scale: turns it down at once where it would be louder, and
// up again within a second.
//
// Units/frames: samples at 48 kHz, stereo interleaved.
// Ownership:    plain value, no heap.
// Threads:      none inside.
// Failure:      none; what is quiet enough passes unchanged.
#pragma once

#include <algorithm>
#include <cmath>
#include <span>

namespace dance {

class Limiter {
 public:
  static constexpr float kLoudest = 0.95f;

  void limit(std::span<float> stereo) {
    for (std::size_t i = 0; i + 1 < stereo.size(); i += 2) {
      const float peak = std::max(std::abs(stereo[i]), std::abs(stereo[i + 1]));
      gain_ += (1.0f - gain_) * kRelease;
      if (peak * gain_ > kLoudest) gain_ = kLoudest / peak;
      stereo[i] *= gain_;
      stereo[i + 1] *= gain_;
    }
  }

 private:
  static constexpr float kRelease = 1.0f / 9600.0f;
  float gain_ = 1.0f;
};

}  // namespace dance
