// VolumeRamp: how loud a sound is played, which may change while it plays: from one volume to the
// next in kRamp_s, so that no step is heard as a click.
//
// Units/frames: factors, 1 = as it is; interleaved stereo.
// Ownership:    plain value.
// Threads:      none inside.
// Failure:      none.
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>

namespace dance {

class VolumeRamp {
 public:
  static constexpr double kRamp_s = 0.02;

  VolumeRamp(double volume, double rate_hz)
      : volume_(static_cast<float>(volume)),
        wanted_(volume_),
        most_(static_cast<float>(1.0 / (kRamp_s * rate_hz))) {}

  void set(double volume) { wanted_ = static_cast<float>(volume); }
  void apply(std::span<float> stereo) {
    for (std::size_t i = 0; i + 1 < stereo.size(); i += 2) {
      volume_ += std::clamp(wanted_ - volume_, -most_, most_);
      stereo[i] *= volume_;
      stereo[i + 1] *= volume_;
    }
  }

 private:
  float volume_, wanted_, most_;  // most: by so much from one frame to the next
};

}  // namespace dance
